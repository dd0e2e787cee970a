// Tools of the shipped case, for gmsh with its OpenCASCADE kernel. Lengths in millimetres, z up.
// The STEP files beside this script are what it makes; a test makes them again and compares.
//   gmsh make_tools.geo -setnumber tool 1 -0 -o punch.step     (1 punch, 2 die, 3 binder)
SetFactory("OpenCASCADE");
DefineConstant[ tool = {1, Choices{1 = "punch", 2 = "die", 3 = "binder"}, Name "tool"} ];

half_width = 200;  // of die and binder: a blank of 320 mm and a margin of 40 mm

If (tool == 1)
  // Hemisphere with its apex at the origin, carried on by a cylinder.
  radius = 70;
  shaft = 100;
  Sphere(1) = {0, 0, radius, radius, -Pi/2, 0};
  Cylinder(2) = {0, 0, radius, 0, 0, shaft, radius};
  BooleanUnion(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
EndIf

If (tool == 2)
  // Plate with a round opening; its top face is z = 0 and its edge is rounded. Deeper than the stroke of 70 mm.
  opening = 72;
  fillet = 20;
  depth = 100;
  Box(1) = {-half_width, -half_width, -depth, 2 * half_width, 2 * half_width, depth};
  Cylinder(2) = {0, 0, -depth, 0, 0, depth, opening};
  BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
  edge() = Curve In BoundingBox{-opening - 1, -opening - 1, -1, opening + 1, opening + 1, 1};
  Fillet{3}{edge()}{fillet}
EndIf

If (tool == 3)
  // Plate with a round opening; its lower face is z = 0 and its edge is rounded.
  opening = 92;
  fillet = 2;
  height = 40;
  Box(1) = {-half_width, -half_width, 0, 2 * half_width, 2 * half_width, height};
  Cylinder(2) = {0, 0, 0, 0, 0, height, opening};
  BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
  edge() = Curve In BoundingBox{-opening - 1, -opening - 1, -1, opening + 1, opening + 1, 1};
  Fillet{3}{edge()}{fillet}
EndIf
