use super::*;

fn refused(body: &str, content: Content) -> Option<String> {
    refusal(body, content).map(|(key, found, expected)| format!("{key}: found {found}, expected {expected}"))
}

#[test]
fn known_headers() {
    for (content, body) in [
        (Content::Nodes, "NODE        X           Y           Z         THXY    THYZ    THZX"),
        (Content::Nodes, "LIST ALL SELECTED NODES.   DSYS=      0"),
        (Content::Nodes, "SORT TABLE ON  NODE  NODE  NODE"),
        (Content::Nodes, "Node No., X [m], Y [m], Z [m]"),
        (Content::Nodes, "node number x_m y_m z_m"),
        (Content::Nodes, "coordinates of the nodes in m"),
        (Content::Nodes, "------  ----  ----"),
        (Content::Nodes, "节点 坐标"),
        (Content::Elements, "ELEM MAT TYP REL ESY SEC        NODES"),
        (Content::Elements, "LIST ALL SELECTED ELEMENTS.  (LIST NODES)"),
        (Content::Elements, "id mat n1 n2 n3 n4"),
        (Content::Constraints, "NODE  LABEL     REAL           IMAG"),
        (Content::Constraints, "LIST CONSTRAINTS FOR SELECTED NODES         1 TO       32 BY        1"),
        (Content::Surface, "vertices and triangles"),
    ] {
        assert_eq!(refused(body, content), None, "{body}");
    }
}

#[test]
fn rejects_other_coordinates_units_and_orders() {
    for (body, expected) in [
        ("LIST ALL SELECTED NODES.   DSYS=      1", "coordinate system: found DSYS = 1, expected DSYS = 0"),
        ("DSYS= 11", "coordinate system: found DSYS = 11"),
        ("LIST NODES DSYS = 2", "coordinate system: found DSYS = 2"),
        ("NODE R THETA Z", "coordinate system: found \"NODE R THETA Z\""),
        ("cylindrical coordinates", "coordinate system: "),
        ("NODE X [mm] Y [mm] Z [mm]", "unit of the heading: found mm in "),
        ("node x_mm y_mm z_mm", "unit of the heading: found mm in "),
        ("coordinates in millimetres", "unit of the heading: found millimetres in "),
        ("id x(in) y(in) z(in)", "unit of the heading: found in in "),
        ("ID X Y Z (ft)", "unit of the heading: found ft in "),
        ("NODE Y X Z", "heading: found \"NODE Y X Z\", expected columns in the order id x y z"),
        ("X Y Z NODE", "heading: found "),
        ("NODE UX UY UZ", "node list: found \"NODE UX UY UZ\", expected a row of numbers"),
        ("Embankment, stage 2", "node list: found \"Embankment, stage 2\""),
    ] {
        let found = refused(body, Content::Nodes).unwrap_or_default();
        assert!(found.starts_with(expected), "{body}: {found}");
    }
    let found = refused("MAT ELEM N1 N2", Content::Elements).unwrap();
    assert!(found.ends_with("expected columns in the order id mat n1…n20"), "{found}");
    assert!(refused("DIR NODE VALUE", Content::Constraints).unwrap().starts_with("heading: "));
}
