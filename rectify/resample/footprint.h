// The ellipse of the photograph that one texel gathers.
#pragma once

#include <array>

namespace glint {

// How the image point moves with the texel: columns are d(x, y)/d(column) and d(x, y)/d(row),
// pixels.
struct TexelJacobian {
  double x_by_column, x_by_row, y_by_column, y_by_row;

  double Determinant() const { return x_by_column * y_by_row - x_by_row * y_by_column; }
  bool Mirrored() const { return Determinant() <= 0; }
};

// An offset (dx, dy) in pixels lies at squared radius xx·dx² + xy·dx·dy + yy·dy² in texels. Axes
// shorter than a pixel are lengthened to one: there the kernel interpolates instead of low-passing
// (P. Heckbert 1989's elliptical weighted average, with clamped axes instead of added variances, so
// that it does not blur at 1:1).
struct Footprint {
  double xx, xy, yy;
  double variance_xx, variance_yy;  // half extents at radius r: r·sqrt(variance)
};

Footprint FootprintFromJacobian(const TexelJacobian& jacobian);

}  // namespace glint
