// A monolithic compliant gripper cut from a 5 mm polymer plate [mm].
// SPDX-License-Identifier: BSD-3-Clause
//
// A bolted C-shaped frame carries two jaws on leaf hinges.  A shaft in the middle, guided by a
// pair of leaf springs, pulls both jaws shut through two links; a pin in the shaft's eye drives it.
//
//   gmsh -2 gripper.geo -o gripper.msh

SetFactory("OpenCASCADE");

t = 0.8;       // thickness of the hinge leaves
tg = 0.6;      // thickness of the guide springs
r = 0.8;       // root fillets of leaves
coarse = 2.3;  // mesh size in the thick parts
across = 4;    // elements through a leaf (even: the mesh is made twice as coarse, then split)

// --- One half: y > 0 -------------------------------------------------------------------------
// Frame: plate, arm and the leg that carries the hinge.
Rectangle(1) = {-14, -36, 0, 14, 72, 3};
Rectangle(2) = {-14, 27, 0, 58, 9, 2.5};
Rectangle(3) = {33, 15.5, 0, 11, 17, 1.2};
// Shaft with its cross-head.
Rectangle(4) = {5, -5.5, 0, 22, 11, 1.2};
Rectangle(5) = {20.5, -14, 0, 6.5, 28, 1.2};
// Link: a bar between a notch hinge (left) and a leaf (right).
Rectangle(6) = {26, 9.2, 0, 17, 3.6, 0.3};

// Jaw: block, tapered finger, grip with a V-groove for round objects.
Point(1001) = {55, 7, 0};       Point(1002) = {62, 6.8, 0};
Point(1003) = {80, 14.2, 0};    Point(1004) = {85.2, 15.6, 0};
Point(1005) = {87.6, 13.2, 0};  Point(1006) = {96.1, 16.13, 0};
Point(1007) = {98.6, 19.8, 0};  Point(1008) = {102.7, 18.41, 0};
Point(1009) = {111.2, 21.34, 0};Point(1010) = {113.2, 24.2, 0};
Point(1011) = {110.6, 26.6, 0}; Point(1012) = {82, 25.6, 0};
Point(1013) = {62, 25.4, 0};    Point(1014) = {56, 25.4, 0};
Point(1015) = {54, 23.4, 0};    Point(1016) = {54, 8, 0};
Point(1017) = {56, 23.4, 0};    Point(1018) = {55, 8, 0};
Point(1019) = {110.87, 23.85, 0};
Line(1001) = {1001, 1002};
Spline(1002) = {1002, 1003, 1004};
For k In {1004 : 1008}
  Line(k) = {k, k + 1};
EndFor
Spline(1009) = {1009, 1010, 1011};
Spline(1011) = {1011, 1012, 1013};
Line(1013) = {1013, 1014};
Circle(1014) = {1014, 1017, 1015};
Line(1015) = {1015, 1016};
Circle(1016) = {1016, 1018, 1001};
Curve Loop(1000) = {1001, 1002, 1004, 1005, 1006, 1007, 1008, 1009, 1011, 1013, 1014, 1015, 1016};
Plane Surface(7) = {1000};

// Circular notches: the neck of the link is as thin as a leaf.
Disk(20) = {30.2, 11 + t / 2 + 1.8, 0, 1.8};
Disk(21) = {30.2, 11 - t / 2 - 1.8, 0, 1.8};
// Bolt hole and pin eye.
Disk(22) = {-7, 23, 0, 2.75};
Disk(23) = {12, 0, 0, 3};
Disk(24) = {-7, 0, 0, 5};

// Fillets: a square at the corner (x, y), opening to the side (sx, sy), less a disc.
Macro RootFillet
  Rectangle(n) = {x + Min(0, sx) * f, y + Min(0, sy) * f, 0, f, f};
  Disk(n + 1) = {x + sx * f, y + sy * f, 0, f};
  BooleanDifference(n + 2) = { Surface{n}; Delete; }{ Surface{n + 1}; Delete; };
  fillets() += n + 2;
  n += 10;
Return

n = 100; fillets() = {};
f = 5; x = 0; y = 27; sx = 1; sy = -1; Call RootFillet;
f = 3; x = 33; y = 27; sx = -1; sy = -1; Call RootFillet;
f = 2; x = 20.5; y = 5.5; sx = -1; sy = 1; Call RootFillet;
f = r;
x = 44; y = 21 + t / 2; sx = 1; sy = 1; Call RootFillet;
x = 44; y = 21 - t / 2; sx = 1; sy = -1; Call RootFillet;
x = 54; y = 21 + t / 2; sx = -1; sy = 1; Call RootFillet;
x = 54; y = 21 - t / 2; sx = -1; sy = -1; Call RootFillet;
x = 43; y = 11 + t / 2; sx = 1; sy = 1; Call RootFillet;
x = 43; y = 11 - t / 2; sx = 1; sy = -1; Call RootFillet;
x = 54; y = 11 + t / 2; sx = -1; sy = 1; Call RootFillet;
x = 54; y = 11 - t / 2; sx = -1; sy = -1; Call RootFillet;
x = 9 - tg / 2; y = 5.5; sx = -1; sy = 1; Call RootFillet;
x = 9 + tg / 2; y = 5.5; sx = 1; sy = 1; Call RootFillet;
x = 9 - tg / 2; y = 27; sx = -1; sy = -1; Call RootFillet;
x = 9 + tg / 2; y = 27; sx = 1; sy = -1; Call RootFillet;

// Stubs between the fillets, so that the leaves between them are plain rectangles.
Rectangle(30) = {43, 21 - t / 2, 0, 1 + r, t};
Rectangle(31) = {54 - r, 21 - t / 2, 0, 1 + r, t};
Rectangle(32) = {42, 11 - t / 2, 0, 1 + r, t};
Rectangle(33) = {54 - r, 11 - t / 2, 0, 1 + r, t};
Rectangle(34) = {9 - tg / 2, 4.5, 0, tg, 1 + r};
Rectangle(35) = {9 - tg / 2, 27 - r, 0, tg, 1 + r};

// The leaves: hinge, link, guide.
Rectangle(40) = {44 + r, 21 - t / 2, 0, 10 - 2 * r, t};
Rectangle(41) = {43 + r, 11 - t / 2, 0, 11 - 2 * r, t};
Rectangle(42) = {9 - tg / 2, 5.5 + r, 0, tg, 21.5 - 2 * r};

// --- Both halves -----------------------------------------------------------------------------
half() = {1 : 7, 30 : 35, fillets()};
mirror() = Symmetry {0, 1, 0, 0} { Duplicata { Surface{half()}; } };
holes() = {20 : 23};
other_holes() = Symmetry {0, 1, 0, 0} { Duplicata { Surface{holes()}; } };
leaves() = {40 : 42};
other_leaves() = Symmetry {0, 1, 0, 0} { Duplicata { Surface{leaves()}; } };

all() = {half(), mirror()};
bulk() = BooleanUnion{ Surface{all(0)}; Delete; }{ Surface{all({1 : #all() - 1})}; Delete; };
bulk() = BooleanDifference{ Surface{bulk()}; Delete; }
                          { Surface{holes(), other_holes(), 24}; Delete; };
parts() = BooleanFragments{ Surface{bulk(), leaves(), other_leaves()}; Delete; }{};

// --- Mesh ------------------------------------------------------------------------------------
e = 1e-3;
leaves() = {};
leaves() += Surface In BoundingBox{44 + r - e, 20, -e, 54 - r + e, 22, e};
leaves() += Surface In BoundingBox{43 + r - e, 10, -e, 54 - r + e, 12, e};
leaves() += Surface In BoundingBox{8, 5.5 + r - e, -e, 10, 27 - r + e, e};
leaves() += Surface In BoundingBox{44 + r - e, -22, -e, 54 - r + e, -20, e};
leaves() += Surface In BoundingBox{43 + r - e, -12, -e, 54 - r + e, -10, e};
leaves() += Surface In BoundingBox{8, -27 + r - e, -e, 10, -5.5 - r + e, e};
bodies() = Surface{:};
bodies() -= leaves();

For k In {0 : #leaves() - 1}
  sides() = Boundary{ Surface{leaves(k)}; };
  For m In {0 : #sides() - 1}
    c = Abs(sides(m));
    b() = BoundingBox Curve{c};
    length = Max(b(3) - b(0), b(4) - b(1));
    If (length < 1)
      Transfinite Curve{c} = across / 2 + 1;
    Else
      Transfinite Curve{c} = Ceil(length / 0.8) + 1;
    EndIf
  EndFor
  Transfinite Surface{leaves(k)};
EndFor

// The links and the grips want a finer mesh than the frame.
Field[1] = Box;
Field[1].VIn = 1.6;  Field[1].VOut = 2 * coarse;  Field[1].Thickness = 6;
Field[1].XMin = 26;  Field[1].XMax = 45;  Field[1].YMin = 9;  Field[1].YMax = 13;
Field[2] = Box;
Field[2].VIn = 1.6;  Field[2].VOut = 2 * coarse;  Field[2].Thickness = 6;
Field[2].XMin = 26;  Field[2].XMax = 45;  Field[2].YMin = -13;  Field[2].YMax = -9;
Field[3] = Min;
Field[3].FieldsList = {1, 2};
Background Field = 3;
Mesh.MeshSizeFromCurvature = 15;
Mesh.MeshSizeMin = 0.3;
Mesh.Algorithm = 6;               // frontal Delaunay
Mesh.RecombinationAlgorithm = 0;
Mesh.RecombineAll = 1;
Mesh.SubdivisionAlgorithm = 1;    // split into quadrilaterals only
Mesh.Smoothing = 20;
Mesh.MshFileVersion = 4.1;

// Mirrored surfaces are clockwise.
ReverseMesh Surface{ Surface In BoundingBox{53, -30, -e, 115, 0, e} };

// --- Names -----------------------------------------------------------------------------------
Physical Surface("body") = bodies();
Physical Surface("leaves") = leaves();

bolts() = Curve In BoundingBox{-13, 16, -e, -1, 30, e};
bolts() += Curve In BoundingBox{-13, -30, -e, -1, -16, e};
Physical Curve("bolts") = bolts();
Physical Curve("pin") = Curve In BoundingBox{7, -5, -e, 17, 5, e};
Physical Curve("grip_upper") = Curve In BoundingBox{87.5, 13, -e, 111.3, 21.5, e};
Physical Curve("grip_lower") = Curve In BoundingBox{87.5, -21.5, -e, 111.3, -13, e};
Physical Point("tip_upper") = Point In BoundingBox{111.1, 21.3, -e, 111.3, 21.4, e};
Physical Point("tip_lower") = Point In BoundingBox{111.1, -21.4, -e, 111.3, -21.3, e};
