//! Named objects of a preview: surfaces, lines, spheres.

use trackbed_dem::Vec3;

/// Object.
#[derive(Clone, Debug, Default)]
pub struct Item {
    /// Index in [`super::KINDS`].
    pub kind: usize,
    /// Scene key.
    pub key: String,
    /// Name in the scene.
    pub name: String,
    /// Number of elements, faces, nodes or grains, with unit.
    pub count: String,
    /// Colour `rrggbb`.
    pub colour: &'static str,
    /// Geometry.
    pub shape: Shape,
}

impl Item {
    pub(super) fn new(key: impl Into<String>, name: impl Into<String>, shape: Shape) -> Item {
        Item { key: key.into(), name: name.into(), shape, ..Item::default() }
    }

    pub(super) fn counted(self, count: usize, unit: &str) -> Item {
        let plural = match (count, unit) {
            (1, _) => "",
            (_, "box") => "es",
            _ => "s",
        };
        Item { count: format!("{} {unit}{plural}", grouped(count)), ..self }
    }

    pub(super) fn coloured(self, colour: &'static str) -> Item {
        Item { colour, ..self }
    }
}

/// Digits in groups of three.
fn grouped(count: usize) -> String {
    let digits = count.to_string();
    let group = |(k, digit): (usize, char)| {
        let comma = (k > 0 && (digits.len() - k).is_multiple_of(3)).then_some(',');
        comma.into_iter().chain([digit])
    };
    digits.chars().enumerate().flat_map(group).collect()
}

/// Geometry.
#[derive(Clone, Debug, Default)]
pub struct Shape {
    /// Points [m].
    pub points: Vec<[f64; 3]>,
    /// Point indices of triangles.
    pub triangles: Vec<[u32; 3]>,
    /// Point indices of lines.
    pub edges: Vec<[u32; 2]>,
    /// Centres and radii [m].
    pub spheres: Vec<[f64; 4]>,
    /// Numbers of points, else of spheres: node numbers, grain indices; may be empty.
    pub ids: Vec<u32>,
}

impl Shape {
    /// Adds convex polygons with their edges.
    pub fn polygons<'a>(
        &mut self,
        points: impl IntoIterator<Item = [f64; 3]>,
        polygons: impl IntoIterator<Item = &'a [u32]>,
    ) {
        let first = self.points.len() as u32;
        self.points.extend(points);
        let mut edges = Vec::new();
        for polygon in polygons {
            let at = |k: usize| first + polygon[k % polygon.len()];
            self.triangles.extend((1..polygon.len().saturating_sub(1)).map(|k| [at(0), at(k), at(k + 1)]));
            edges.extend((0..polygon.len()).map(|k| [at(k).min(at(k + 1)), at(k).max(at(k + 1))]));
        }
        edges.sort_unstable();
        edges.dedup();
        self.edges.extend(edges);
    }

    /// Adds the edges of a box.
    pub fn cuboid(low: [f64; 3], high: [f64; 3]) -> Shape {
        let corner = |c: usize| [0, 1, 2].map(|k| if c >> k & 1 == 1 { high[k] } else { low[k] });
        let edges = (0..8_u32).flat_map(|c| [1, 2, 4].map(|bit| [c, c | bit])).filter(|[a, b]| a != b);
        Shape { points: (0..8).map(corner).collect(), edges: edges.collect(), ..Shape::default() }
    }

    /// Adds a block with faces.
    pub fn block(&mut self, low: [f64; 3], high: [f64; 3]) {
        let sides: [&[u32]; 6] =
            [&[0, 2, 3, 1], &[4, 5, 7, 6], &[0, 1, 5, 4], &[2, 6, 7, 3], &[0, 4, 6, 2], &[1, 3, 7, 5]];
        self.polygons(Shape::cuboid(low, high).points, sides);
    }

    /// Adds an arrow of `length` [m] along `direction` that ends at `tip`.
    pub fn arrow(&mut self, tip: [f64; 3], direction: Vec3, length: f64) {
        let Some(along) = direction.try_normalize(0.0) else { return };
        let (tip, (u, v)) = (Vec3::from(tip), across(&along));
        let ring = |far: f64, wide: f64| {
            [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)].map(|(a, b)| {
                <[f64; 3]>::from(tip - along * (far * length) + (u * a + v * b) * (wide * length))
            })
        };
        let cone: [&[u32]; 5] = [&[0, 1, 2], &[0, 2, 3], &[0, 3, 4], &[0, 4, 1], &[4, 3, 2, 1]];
        let shaft: [&[u32]; 4] = [&[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]];
        let lines = self.edges.len();
        self.polygons([tip.into()].into_iter().chain(ring(0.35, 0.12)), cone);
        self.polygons(ring(0.35, 0.04).into_iter().chain(ring(1.0, 0.04)), shaft);
        self.edges.truncate(lines);
    }

    /// Adds a pyramid of height `size` [m] with its apex at `tip`.
    pub fn support(&mut self, tip: [f64; 3], outwards: Vec3, size: f64) {
        let (tip, (u, v)) = (Vec3::from(tip), across(&outwards));
        let base = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
        let base = base.map(|(a, b)| <[f64; 3]>::from(tip + (outwards + (u * a + v * b) * 0.35) * size));
        let sides: [&[u32]; 5] = [&[0, 1, 2], &[0, 2, 3], &[0, 3, 4], &[0, 4, 1], &[4, 3, 2, 1]];
        let lines = self.edges.len();
        self.polygons([tip.into()].into_iter().chain(base), sides);
        self.edges.truncate(lines);
    }

    /// Returns the bounding box [m].
    pub fn bounds(&self) -> Option<[[f64; 3]; 2]> {
        let balls =
            self.spheres.iter().flat_map(|[x, y, z, r]| [[x - r, y - r, z - r], [x + r, y + r, z + r]]);
        union(self.points.iter().copied().chain(balls).map(|x| [x, x]))
    }
}

pub(super) fn union(boxes: impl IntoIterator<Item = [[f64; 3]; 2]>) -> Option<[[f64; 3]; 2]> {
    boxes
        .into_iter()
        .reduce(|a, b| [[0, 1, 2].map(|k| a[0][k].min(b[0][k])), [0, 1, 2].map(|k| a[1][k].max(b[1][k]))])
}

/// Two unit vectors normal to a unit vector and to each other.
pub(super) fn across(n: &Vec3) -> (Vec3, Vec3) {
    let helper = if n.x.abs() < 0.9 { Vec3::x() } else { Vec3::y() };
    let u = n.cross(&helper).normalize();
    (u, n.cross(&u))
}
