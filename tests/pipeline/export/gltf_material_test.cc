#include "pipeline/export/gltf_material.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "base/files/json.h"
#include "base/photos/photo.h"
#include "tests/pipeline/export/exported_material.h"
#include "tests/support/process.h"

namespace glint {
namespace {

using test::kSize;

SvbrdfMaps Maps() {
  SvbrdfMaps maps(kSize, kSize);
  const float planes[] = {0.0f, 0.6f, 0.8f, 0.2f, 0.4f, 0.1f, 0.04f, 0.3f, 0.5f, 0.35f};
  for (int p = 0; p < kSvbrdfPlanes; ++p) {
    std::fill(maps.plane(p).begin(), maps.plane(p).end(), planes[p]);
  }
  for (int c = 0; c < 3; ++c) maps.plane(kSpecularR + c)[7] = 0.8f;
  return maps;
}

float LinearFromSrgb(float v) {
  return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

class GltfTest : public testing::Test {
 protected:
  // Reads a .glb as the specification says.
  void Read(const std::string& bytes) {
    std::uint32_t header[3], length = 0;
    ASSERT_GE(bytes.size(), 20u);
    std::memcpy(header, bytes.data(), sizeof header);
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(header[1], 2u);
    EXPECT_EQ(header[2], bytes.size());
    std::memcpy(&length, bytes.data() + 12, 4);
    EXPECT_EQ(bytes.substr(16, 4), "JSON");
    EXPECT_EQ(length % 4, 0u);
    json_ = Json::parse(bytes.substr(20, length));
    const size_t binary = 20 + length;
    std::memcpy(&length, bytes.data() + binary, 4);
    EXPECT_EQ(bytes.substr(binary + 4, 4), std::string("BIN\0", 4));
    EXPECT_EQ(length % 4, 0u);
    binary_ = bytes.substr(binary + 8);
    EXPECT_EQ(binary_.size(), length);
    EXPECT_LE(json_["buffers"][0]["byteLength"].get<size_t>(), length);
  }
  std::string View(const Json& index) const {
    const Json& view = json_["bufferViews"][index.get<size_t>()];
    EXPECT_EQ(view["byteOffset"].get<size_t>() % 4, 0u);
    return binary_.substr(view["byteOffset"].get<size_t>(), view["byteLength"].get<size_t>());
  }
  // One texel of the texture that the material names, encoded.
  float Texel(const Json& texture, int channel, size_t texel) {
    const Json& source = json_["textures"][texture["index"].get<size_t>()]["source"];
    const auto file = folder_.path() / "texture.png";
    test::WriteAll(file, View(json_["images"][source.get<size_t>()]["bufferView"]));
    return ReadPhoto(file).image.at(texel, channel);
  }

  test::TemporaryFolder folder_;
  Json json_;
  std::string binary_;
};

TEST_F(GltfTest, ThePlaneHasTheSamplesSizeInMetres) {
  Read(GlbOf(test::MaterialOf(Maps()), 1));
  const Json& primitive = json_["meshes"][0]["primitives"][0];
  const Json& positions = json_["accessors"][primitive["attributes"]["POSITION"].get<size_t>()];
  EXPECT_NEAR(positions["max"][0].get<double>() - positions["min"][0].get<double>(), 0.12, 1e-6);
  EXPECT_NEAR(positions["max"][1].get<double>() - positions["min"][1].get<double>(), 0.08, 1e-6);
  const std::string corners = View(positions["bufferView"]);
  ASSERT_EQ(corners.size(), 4 * 3 * sizeof(float));
  float first[3];  // upper left, where the maps' first texel is
  std::memcpy(first, corners.data(), sizeof first);
  EXPECT_FLOAT_EQ(first[0], -0.06f);
  EXPECT_FLOAT_EQ(first[1], 0.04f);
  EXPECT_EQ(json_["nodes"][json_["scenes"][0]["nodes"][0].get<size_t>()]["mesh"], 0);
}

// What glTF's dielectric is made of, put together again.
TEST_F(GltfTest, TexturesSayWhatTheMapsSay) {
  for (const bool whole : {true, false}) {
    Read(GlbOf(
        test::MaterialOf(Maps(), whole ? DiffuseWeight::kOne : DiffuseWeight::kOneMinusSpecular),
        1));
    const Json& material = json_["materials"][0];
    const Json& base = material["pbrMetallicRoughness"];
    const Json& specular = material["extensions"]["KHR_materials_specular"];
    const SvbrdfMaps maps = Maps();
    for (const size_t texel : {size_t{3}, size_t{7}}) {
      float most = 0;
      for (int c = 0; c < 3; ++c) {
        const double f0 = kGltfF0 * specular["specularColorFactor"][c].get<double>() *
                          LinearFromSrgb(Texel(specular["specularColorTexture"], c, texel));
        EXPECT_NEAR(f0, maps.plane(kSpecularR + c)[texel], 0.004);
        most = std::max(most, maps.plane(kSpecularR + c)[texel]);
      }
      for (int c = 0; c < 3; ++c) {
        const double diffuse =
            LinearFromSrgb(Texel(base["baseColorTexture"], c, texel)) * (whole ? 1 - most : 1);
        const double reachable = whole ? 1 - most : 1;
        EXPECT_NEAR(diffuse, std::min<double>(maps.plane(kDiffuseR + c)[texel], reachable), 0.004);
      }
      EXPECT_NEAR(Texel(base["metallicRoughnessTexture"], 1, texel), 0.35, 0.003);
      EXPECT_EQ(base["metallicFactor"], 0.0);
      EXPECT_NEAR(Texel(material["normalTexture"], 1, texel), 0.8, 0.003);  // +Y is up
    }
  }
}

// Of one lobe there is no coat; of two, base and coat reflect together what ours do at normal
// incidence.
TEST_F(GltfTest, ANarrowLobeIsAClearCoat) {
  Read(GlbOf(test::MaterialOf(Maps()), 1));
  EXPECT_FALSE(json_["materials"][0]["extensions"].contains("KHR_materials_clearcoat"));
  ExportedMaterial two = test::MaterialOf(Maps());
  two.convention.lobes = {0.5, 0.4};
  Read(GlbOf(two, 1));
  EXPECT_EQ(json_["extensionsUsed"].size(), 2u);
  const Json& material = json_["materials"][0];
  const Json& specular = material["extensions"]["KHR_materials_specular"];
  const Json& coat = material["extensions"]["KHR_materials_clearcoat"];
  for (const size_t texel : {size_t{3}, size_t{7}}) {
    const double strength = Texel(coat["clearcoatTexture"], 0, texel);
    EXPECT_GT(strength, 0.3);
    for (int c = 0; c < 3; ++c) {
      const double f0 = kGltfF0 * specular["specularColorFactor"][c].get<double>() *
                        LinearFromSrgb(Texel(specular["specularColorTexture"], c, texel));
      EXPECT_NEAR(f0 + kGltfF0 * strength, two.maps.plane(kSpecularR + c)[texel], 0.004);
    }
    const Json& base = material["pbrMetallicRoughness"];
    const double wide = Texel(base["metallicRoughnessTexture"], 1, texel);
    const double narrow = Texel(coat["clearcoatRoughnessTexture"], 1, texel);
    EXPECT_NEAR(narrow / wide, 0.4, 0.01);
    EXPECT_NEAR(wide * narrow, 0.35 * 0.35, 0.004);
  }
}

TEST_F(GltfTest, ACoatIsTheClearCoatAndTheMapTheBases) {
  ExportedMaterial coated = test::MaterialOf(Maps());
  coated.convention.lobes = {0.6, 0.4, 0.04};
  Read(GlbOf(coated, 1));
  const Json& extensions = json_["materials"][0]["extensions"];
  const Json& specular = extensions["KHR_materials_specular"];
  for (const size_t texel : {size_t{3}, size_t{7}}) {
    EXPECT_NEAR(Texel(extensions["KHR_materials_clearcoat"]["clearcoatTexture"], 0, texel),
                0.6 * 0.04 / kGltfF0, 0.004);
    for (int c = 0; c < 3; ++c) {
      const double f0 = kGltfF0 * specular["specularColorFactor"][c].get<double>() *
                        LinearFromSrgb(Texel(specular["specularColorTexture"], c, texel));
      EXPECT_NEAR(f0, 0.4 * coated.maps.plane(kSpecularR + c)[texel], 0.004);
    }
  }
}

TEST_F(GltfTest, AnisotropicLobesHaveTheirWidthsAlongAndAcross) {
  ExportedMaterial wood = test::MaterialOf(Maps());
  wood.convention.lobes.anisotropy = {2.25, 90};
  Read(GlbOf(wood, 1));
  EXPECT_EQ(json_["extensionsUsed"].size(), 2u);
  const Json& material = json_["materials"][0];
  const Json& anisotropy = material["extensions"]["KHR_materials_anisotropy"];
  EXPECT_NEAR(anisotropy["anisotropyRotation"], std::numbers::pi / 2, 1e-6);
  for (const size_t texel : {size_t{3}, size_t{7}}) {
    const Json& texture = anisotropy["anisotropyTexture"];
    EXPECT_NEAR(Texel(texture, 0, texel), 1, 0.003);  // the tangent itself, which is then turned
    EXPECT_NEAR(Texel(texture, 1, texel), 0.5, 0.003);
    const double roughness =
        Texel(material["pbrMetallicRoughness"]["metallicRoughnessTexture"], 1, texel);
    const double across = roughness * roughness, strength = Texel(texture, 2, texel);
    const double along = across + (1 - across) * strength * strength;
    EXPECT_NEAR(along / across, 2.25, 0.06);
    EXPECT_NEAR(std::sqrt(along * across), 0.35 * 0.35, 0.003);
  }
}

TEST_F(GltfTest, TheSameMapsGiveTheSameBytes) {
  const auto once = GlbOf(test::MaterialOf(Maps()), 1);
  EXPECT_EQ(once, GlbOf(test::MaterialOf(Maps()), 3));
}

}  // namespace
}  // namespace glint
