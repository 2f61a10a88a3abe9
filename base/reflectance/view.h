// How a flat sample is seen and lit in one photograph, and where its texels lie.
#pragma once

#include <array>

#include "base/reflectance/characteristic_curve.h"
#include "base/reflectance/convention.h"

namespace glint {

using Vec3d = std::array<double, 3>;  // plain, so that the renderer and trainer need no Eigen

// One view of the sample. Sample frame: millimetres, origin at the sample's centre, x right, y up,
// z toward the viewer. Observed radiance of a texel is
//   exposure · ( E·f·NoL + ambient_rgb · (w·k_d + k_s)/π ),   E from light_rgb by the convention's
//   falloff,
// where w is the convention's diffuse weight.
struct View {
  Vec3d camera_in_sample_mm{0, 0, 0};
  Vec3d light_in_sample_mm{0, 0, 0};
  Vec3d light_rgb{1, 1, 1};    // power: radiance·mm² (inverse square) or irradiance (no falloff)
  Vec3d ambient_rgb{0, 0, 0};  // irradiance of a uniform surround
  double exposure = 1.0;
  // Gradient of the logarithm of the light's radiant intensity by the tangents of its direction to
  // the texel, (texel − light)_xy / light_z. The fused renderer knows lights of equal intensity
  // only; TexelGeometryInView and RenderLit (render/render_lit.h) know both.
  std::array<double, 2> beam{0, 0};
  // Of the photograph, which renderers do not apply.
  CharacteristicCurve curve = {};
};

// What a part of a plane of texels is a part of, in the whole's texels.
struct PlaneOfPart {
  int width = 0, height = 0;                        // 0: it is the whole
  int first_column = 0, first_row = 0, stride = 1;  // of the part
};

// The plane z = 0 of a rectified sample cut into texels; row 0 is at +y. Or a part of it, whose
// texels lie where they lie in the whole: consecutive rows, or every so many-th texel.
struct SamplePlane {
  int width = 0;
  int height = 0;
  double width_mm = 0;  // of the whole, as height_mm
  double height_mm = 0;
  TexelSampling sampling = TexelSampling::kPixelCentres;
  PlaneOfPart whole = {};

  double x_mm(int column) const {
    return Coordinate(whole.first_column + whole.stride * column, whole_width()) * width_mm;
  }
  double y_mm(int row) const {
    return -Coordinate(whole.first_row + whole.stride * row, whole_height()) * height_mm;
  }
  int whole_width() const { return whole.width > 0 ? whole.width : width; }
  int whole_height() const { return whole.height > 0 ? whole.height : height; }

  // Of the whole plane: `rows` rows from `first_row` on.
  SamplePlane Rows(int first_row, int rows) const {
    SamplePlane part = *this;
    part.height = rows;
    part.whole = {width, height, 0, first_row, 1};
    return part;
  }
  // Of the whole plane: the texel in the middle of every stride × stride.
  SamplePlane Every(int stride) const {
    SamplePlane part = *this;
    part.width = (width + stride - 1 - stride / 2) / stride;
    part.height = (height + stride - 1 - stride / 2) / stride;
    part.whole = {width, height, stride / 2, stride / 2, stride};
    return part;
  }

 private:
  // Position of sample i of n in [-1/2, 1/2].
  double Coordinate(int i, int n) const {
    if (sampling == TexelSampling::kPixelCentres) return (i + 0.5) / n - 0.5;
    return n > 1 ? static_cast<double>(i) / (n - 1) - 0.5 : 0.0;
  }
};

// DIR 2019's synthetic geometry: the plane [−1, 1]² in units of 1 (here mm), E = π without falloff,
// camera = light; view 0 at (0, 0, 2.146), others with x, y uniform in ±1.2 at the same height.
inline constexpr double kDirHeight = 2.146;
inline constexpr double kDirJitter = 1.2;
inline View DirView(double x, double y) {
  constexpr double kPi = 3.14159265358979323846;
  View view;
  view.camera_in_sample_mm = view.light_in_sample_mm = {x, y, kDirHeight};
  view.light_rgb = {kPi, kPi, kPi};
  return view;
}

}  // namespace glint
