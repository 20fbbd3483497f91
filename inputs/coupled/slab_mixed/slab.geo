// Slab of 8-node bricks about the middle and 6-node wedges around them:
//   gmsh -3 -format msh41 slab.geo -o slab.msh && trackbed mesh convert slab.msh slab.inp
Point(1) = {-0.5, -0.5, -0.3};
Point(2) = { 0.5, -0.5, -0.3};
Point(3) = { 0.5,  0.5, -0.3};
Point(4) = {-0.5,  0.5, -0.3};
Point(5) = {-0.2, -0.2, -0.3};
Point(6) = { 0.2, -0.2, -0.3};
Point(7) = { 0.2,  0.2, -0.3};
Point(8) = {-0.2,  0.2, -0.3};
For k In {1 : 4}
  Line(k) = {k, k % 4 + 1};
  Line(4 + k) = {4 + k, 4 + k % 4 + 1};
EndFor
Curve Loop(1) = {1, 2, 3, 4};
Curve Loop(2) = {5, 6, 7, 8};
Plane Surface(1) = {1, 2};
Plane Surface(2) = {2};
Transfinite Curve {5, 6, 7, 8} = 5;
Transfinite Curve {1, 2, 3, 4} = 9;
Transfinite Surface {2};
Recombine Surface {2};
outer[] = Extrude {0, 0, 0.3} { Surface{1}; Layers{3}; Recombine; };
inner[] = Extrude {0, 0, 0.3} { Surface{2}; Layers{3}; Recombine; };
Physical Volume("soil", 1) = {outer[1], inner[1]};
