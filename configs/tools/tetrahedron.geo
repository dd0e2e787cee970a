// Tools of configs/tetrahedron.yaml, for gmsh with its OpenCASCADE kernel. Lengths in millimetres, z up.
// A three-sided pyramid with rounded edges, as tetrahedral preforms have it; all sizes are ours. Its plan is centred on
// the punch axis. The STEP files beside this script are what it makes; the binder of the case is a plain ring.
//   gmsh tetrahedron.geo -setnumber tool 1 -0 -o tetrahedron_punch.step     (1 punch, 2 die)
SetFactory("OpenCASCADE");
DefineConstant[ tool = {1, Choices{1 = "punch", 2 = "die"}, Name "tool"} ];

half_width = 170;  // of the die

If (tool == 1)
  // Apex at z = 0 before it is rounded, edges along 90, 210 and 330 degrees.
  corner = 87;   // radius of the corners of the upper face
  height = 80;
  round = 12;    // of the three edges and the apex
  Point(1) = {0, 0, 0};
  For k In {0:2}
    Point(2 + k) = {corner * Cos(Pi/2 + k * 2*Pi/3), corner * Sin(Pi/2 + k * 2*Pi/3), height};
  EndFor
  Line(1) = {1, 2}; Line(2) = {1, 3}; Line(3) = {1, 4};
  Line(4) = {2, 3}; Line(5) = {3, 4}; Line(6) = {4, 2};
  Curve Loop(1) = {1, 4, -2}; Plane Surface(1) = {1};
  Curve Loop(2) = {2, 5, -3}; Plane Surface(2) = {2};
  Curve Loop(3) = {3, 6, -1}; Plane Surface(3) = {3};
  Curve Loop(4) = {4, 5, 6}; Plane Surface(4) = {4};
  Surface Loop(1) = {1, 2, 3, 4};
  Volume(1) = {1};
  Fillet{1}{1, 2, 3}{round}
EndIf

If (tool == 2)
  // Plate with a triangular opening whose corners are rounded; its top face is z = 0 and its edge is rounded.
  inner = 40;    // radius of the circle inside the opening
  corner = 15;   // of its corners
  fillet = 10;   // of the edge
  depth = 90;
  far = inner - corner;  // triangle of the centres of the corners: inner radius
  For k In {0:2}
    cx~{k} = 2 * far * Cos(Pi/2 + k * 2*Pi/3);
    cy~{k} = 2 * far * Sin(Pi/2 + k * 2*Pi/3);
  EndFor
  p = newp;
  For k In {0:2}
    // Normals of the two sides that meet at corner k point at 30 and 150 degrees about it.
    a = Pi/2 + k * 2*Pi/3;
    Point(p + 3*k) = {cx~{k} + corner * Cos(a - Pi/3), cy~{k} + corner * Sin(a - Pi/3), -depth};
    Point(p + 3*k + 1) = {cx~{k}, cy~{k}, -depth};
    Point(p + 3*k + 2) = {cx~{k} + corner * Cos(a + Pi/3), cy~{k} + corner * Sin(a + Pi/3), -depth};
  EndFor
  For k In {0:2}
    Circle(10 + 2*k) = {p + 3*k, p + 3*k + 1, p + 3*k + 2};
    Line(11 + 2*k) = {p + 3*k + 2, p + 3*((k + 1) % 3)};
  EndFor
  Curve Loop(1) = {10, 11, 12, 13, 14, 15};
  Plane Surface(1) = {1};
  hole() = Extrude {0, 0, depth} { Surface{1}; };
  Box(50) = {-half_width, -half_width, -depth, 2 * half_width, 2 * half_width, depth};
  BooleanDifference(60) = { Volume{50}; Delete; }{ Volume{hole(1)}; Delete; };
  reach = 2 * inner;
  edge() = Curve In BoundingBox{-reach, -reach, -1, reach, reach, 1};
  Fillet{60}{edge()}{fillet}
EndIf
