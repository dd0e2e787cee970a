// Tools of configs/double_dome.yaml, for gmsh with its OpenCASCADE kernel. Lengths in millimetres, z up.
// A shape like the double dome of the forming benchmark, two domes joined by a lower waist; all sizes are ours, because
// the published drawing was not at hand. The STEP files beside this script are what it makes.
//   gmsh double_dome.geo -setnumber tool 1 -0 -o double_dome_punch.step     (1 punch, 2 die, 3 binder)
SetFactory("OpenCASCADE");
DefineConstant[ tool = {1, Choices{1 = "punch", 2 = "die", 3 = "binder"}, Name "tool"} ];

half_distance = 55;  // of the domes' axes from the middle
dome = 50;           // radius of each dome
waist = 42;          // radius of the cylinder that joins them, whose axis is level with the domes' centres
clearance = 2;       // beside the domes
fillet = 15;         // of the die's edge
half_length = 220;   // of die and binder
half_width = 160;

If (tool == 1)
  // Apexes at z = 0; straight walls above the domes' centres.
  shaft = 60;
  Sphere(1) = {-half_distance, 0, dome, dome, -Pi/2, 0};
  Sphere(2) = {half_distance, 0, dome, dome, -Pi/2, 0};
  Cylinder(3) = {-half_distance, 0, dome, 0, 0, shaft, dome};
  Cylinder(4) = {half_distance, 0, dome, 0, 0, shaft, dome};
  Cylinder(5) = {-half_distance, 0, dome, 2 * half_distance, 0, 0, waist};
  Box(6) = {-half_distance, -waist, dome, 2 * half_distance, 2 * waist, shaft};
  BooleanUnion(7) = { Volume{1}; Delete; }{ Volume{2, 3, 4, 5, 6}; Delete; };
EndIf

If (tool == 2)
  // Plate with an opening like a stadium; its top face is z = 0 and its edge is rounded.
  opening = dome + clearance;
  depth = 90;
  Box(1) = {-half_length, -half_width, -depth, 2 * half_length, 2 * half_width, depth};
  Cylinder(2) = {-half_distance, 0, -depth, 0, 0, depth, opening};
  Cylinder(3) = {half_distance, 0, -depth, 0, 0, depth, opening};
  Box(4) = {-half_distance, -opening, -depth, 2 * half_distance, 2 * opening, depth};
  BooleanUnion(5) = { Volume{2}; Delete; }{ Volume{3, 4}; Delete; };
  BooleanDifference(6) = { Volume{1}; Delete; }{ Volume{5}; Delete; };
  edge() = Curve In BoundingBox{-half_distance - opening - 1, -opening - 1, -1, half_distance + opening + 1, opening + 1, 1};
  Fillet{6}{edge()}{fillet}
EndIf

If (tool == 3)
  // Plate with a larger opening of the same form; its lower face is z = 0.
  opening = dome + clearance + fillet + 3;
  height = 30;
  Box(1) = {-half_length, -half_width, 0, 2 * half_length, 2 * half_width, height};
  Cylinder(2) = {-half_distance, 0, 0, 0, 0, height, opening};
  Cylinder(3) = {half_distance, 0, 0, 0, 0, height, opening};
  Box(4) = {-half_distance, -opening, 0, 2 * half_distance, 2 * opening, height};
  BooleanUnion(5) = { Volume{2}; Delete; }{ Volume{3, 4}; Delete; };
  BooleanDifference(6) = { Volume{1}; Delete; }{ Volume{5}; Delete; };
  edge() = Curve In BoundingBox{-half_distance - opening - 1, -opening - 1, -1, half_distance + opening + 1, opening + 1, 1};
  Fillet{6}{edge()}{3}
EndIf
