// Writing the curves of an airfoil with OCCT: interpolation and STEP.
#pragma once
#include "rust/cxx.h"

namespace occt {

// The C2 spline through points (x, y one after the other) from one end of the trailing edge round the nose, which has the given number, to
// the other end; where the ends differ, a straight base between them. Written as STEP, curves without a face.
void write_airfoil(rust::Str path, rust::Slice<const double> points, std::size_t nose);

} // namespace occt
