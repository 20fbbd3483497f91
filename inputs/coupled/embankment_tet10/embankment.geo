// Slice of an embankment, 0.6 m long, slopes 1 : 1.5. Free mesh of 10-node tetrahedra:
//   gmsh -3 -order 2 -format msh41 embankment.geo -o embankment.msh
Point(1) = {-2.0, 0, -0.6};
Point(2) = { 2.0, 0, -0.6};
Point(3) = { 1.1, 0,  0.0};
Point(4) = {-1.1, 0,  0.0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
body[] = Extrude {0, 0.6, 0} { Surface{1}; };
Physical Volume("fill", 1) = {body[1]};
Mesh.MeshSizeMin = 0.2;
Mesh.MeshSizeMax = 0.2;
