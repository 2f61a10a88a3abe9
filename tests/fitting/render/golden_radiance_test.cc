// Radiances that golden_radiance.py computed once, by the formulas of the paper and nothing of
// Glint's: they pin the reflectance model, however it is written here.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "base/reflectance/brdf.h"
#include "base/reflectance/texel_at.h"
#include "fitting/render/renderer.h"

namespace glint {
namespace {

struct Golden {
  ReflectanceConvention convention;
  View view;
  SvbrdfMaps maps{1, 1};  // of one texel, at the sample's centre
  std::array<double, 3> radiance{};
};

class Row {
 public:
  explicit Row(const std::string& line) : fields_(line) {}
  std::string Text() {
    std::string field;
    std::getline(fields_, field, ',');
    return field;
  }
  std::vector<double> Numbers() {
    std::istringstream text(Text());
    std::vector<double> numbers;
    for (double number = 0; text >> number;) numbers.push_back(number);
    return numbers;
  }
  Vec3d Three() {
    const std::vector<double> numbers = Numbers();
    return {numbers.at(0), numbers.at(1), numbers.at(2)};
  }

 private:
  std::istringstream fields_;
};

std::vector<Golden> ReadGolden() {
  std::ifstream file(std::filesystem::path(GLINT_SOURCE_DIR) /
                     "tests/fitting/render/golden_radiance.csv");
  std::string line;
  std::getline(file, line);  // of headings
  std::vector<Golden> all;
  while (std::getline(file, line)) {
    Row row(line);
    Golden& golden = all.emplace_back();
    golden.convention = ParseReflectanceConvention(row.Text());
    golden.view.camera_in_sample_mm = row.Three();
    golden.view.light_in_sample_mm = row.Three();
    golden.view.light_rgb = row.Three();
    golden.view.ambient_rgb = row.Three();
    golden.view.exposure = row.Numbers().at(0);
    for (const int plane : {kNormalX, kDiffuseR, kSpecularR}) {
      const Vec3d values = row.Three();
      for (size_t c = 0; c < 3; ++c) {
        golden.maps.plane(plane + static_cast<int>(c))[0] = static_cast<float>(values[c]);
      }
    }
    golden.maps.plane(kRoughness)[0] = static_cast<float>(row.Numbers().at(0));
    golden.radiance = row.Three();
  }
  return all;
}

TEST(GoldenRadiance, IsWhatTheFormulasOfBrdfGive) {
  const std::vector<Golden> all = ReadGolden();
  ASSERT_EQ(all.size(), 216u);
  for (const Golden& golden : all) {
    const TexelGeometry<double> geometry =
        TexelGeometryInView(golden.view, golden.convention.falloff, 0.0, 0.0);
    double radiance[3];
    ShadeRadiance(TexelAt(golden.maps, 0), geometry, golden.convention, radiance);
    for (size_t c = 0; c < 3; ++c) {
      // The maps are single precision.
      EXPECT_NEAR(radiance[c], golden.radiance[c], 2e-5 * golden.radiance[c]);
    }
  }
}

TEST(GoldenRadiance, IsWhatTheRendererGives) {
  for (const Golden& golden : ReadGolden()) {
    const SamplePlane plane{1, 1, 1.0, 1.0, TexelSampling::kPixelCentres};
    float radiance[3];
    RenderView(golden.maps, plane, golden.view, golden.convention, radiance);
    for (size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(radiance[c], golden.radiance[c], 1e-4 * golden.radiance[c]);
    }
  }
}

}  // namespace
}  // namespace glint
