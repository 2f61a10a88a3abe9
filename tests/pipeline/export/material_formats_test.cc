#include "pipeline/export/material_formats.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "base/errors/errors.h"
#include "pipeline/export/direction_pairs.h"
#include "tests/pipeline/export/exported_material.h"
#include "tests/support/process.h"

namespace glint {
namespace {

using testing::HasSubstr;

const std::array<float, kSvbrdfPlanes> kValues = {0,    0,    1,     0.4f,  0.3f,
                                                  0.2f, 0.1f, 0.08f, 0.06f, 0.4f};

std::string FileOfMap(const std::string& map) { return "wood_" + map + ".png"; }

const MaterialFormat& Format(const std::string& name) {
  static std::vector<MaterialFormat> chosen;
  chosen = ChosenFormats({name});
  return chosen.front();
}

std::string WrittenText(const std::string& name, DiffuseWeight weight = DiffuseWeight::kOne) {
  return Format(name).write(test::MaterialOf(test::UniformMaps(kValues), weight), FileOfMap, 1);
}

// Every node that another reads is there.
TEST(MaterialFormatsTest, MaterialXNamesTheNodesItConnects) {
  for (const auto weight : {DiffuseWeight::kOne, DiffuseWeight::kOneMinusSpecular}) {
    const std::string text = WrittenText("materialx", weight);
    const std::regex connected("node(?:name|graph)=\"([a-z_]+)\"");
    int connections = 0;
    for (std::sregex_iterator i(text.begin(), text.end(), connected), end; i != end; ++i) {
      EXPECT_THAT(text, HasSubstr(" name=\"" + (*i)[1].str() + "\""));
      ++connections;
    }
    EXPECT_GT(connections, 10);
    EXPECT_THAT(text, HasSubstr("generalized_schlick_bsdf"));
    EXPECT_EQ(text.find("invert") != std::string::npos, weight != DiffuseWeight::kOne);
  }
}

TEST(MaterialFormatsTest, UsdHasThePlaneInMetresAndClosesWhatItOpens) {
  const std::string text = WrittenText("usd");
  EXPECT_THAT(text, HasSubstr("metersPerUnit = 1"));
  EXPECT_THAT(text, HasSubstr("(-0.06, -0.04, 0)"));
  EXPECT_THAT(text, HasSubstr("asset inputs:file = @wood_specular.png@"));
  EXPECT_THAT(text, HasSubstr("int inputs:useSpecularWorkflow = 1"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '{'), std::count(text.begin(), text.end(), '}'));
}

TEST(MaterialFormatsTest, UsdNamesPrimsByIdentifiers) {
  ExportedMaterial material = test::MaterialOf(test::UniformMaps(kValues));
  material.name = "2nd-oak.v1";
  const std::string text = Format("usd").write(material, FileOfMap, 1);
  EXPECT_THAT(text, HasSubstr("def Xform \"_2nd_oak_v1\""));
}

TEST(MaterialFormatsTest, BlendersScriptHasTrueScale) {
  const std::string text = WrittenText("blender");
  EXPECT_THAT(text, HasSubstr("WIDTH_M, HEIGHT_M = 0.12, 0.08"));
  EXPECT_THAT(text, HasSubstr("HEIGHT_LOW_M, HEIGHT_RANGE_M = -0.0005, 0.00125"));
  EXPECT_THAT(text, HasSubstr("DIFFUSE_WHOLE = True"));
  EXPECT_THAT(WrittenText("blender", DiffuseWeight::kOneMinusSpecular),
              HasSubstr("DIFFUSE_WHOLE = False"));
}

TEST(MaterialFormatsTest, BlendersScriptDisplacesInEveryVersion) {
  const test::TemporaryFolder folder;
  const std::filesystem::path script = folder / "material.py";
  test::WriteAll(script, WrittenText("blender"));
  for (const std::string owner : {"material", "cycles"}) {
    const test::Outcome run =
        test::RunProgram({"python3", GLINT_STAND_IN_BPY, script.string(), owner});
    EXPECT_EQ(run.code, 0) << owner << run.err;
    EXPECT_EQ(run.out, "DISPLACEMENT\n") << owner;
  }
}

// The formats that keep F0 are nearer to ours than base colour and metalness alone can be.
TEST(MaterialFormatsTest, WholeMaterialsAreMoreFaithfulThanMetalRoughness) {
  const ExportedMaterial material = test::MaterialOf(test::UniformMaps(kValues));
  const auto error_of = [&](const Shading& shading) {
    return ShadingErrors(material.maps, material.convention, {shading}, 1)[0];
  };
  const double metal_roughness = error_of(MetalRoughnessShading(material.metal, material.maps));
  for (const MaterialFormat& format : MaterialFormats()) {
    const double error = error_of([&](size_t texel, const DirectionPair& pair) {
      return format.brdf(material, texel, pair);
    });
    EXPECT_GT(error, 0) << format.name;
    EXPECT_LT(error, 0.06) << format.name;
    EXPECT_LT(error, metal_roughness) << format.name;
  }
}

ExportedMaterial TwoLobes(double coat_f0 = 0) {
  ExportedMaterial material = test::MaterialOf(test::UniformMaps(kValues));
  material.convention.lobes = {0.5, 0.4, coat_f0};
  material.metal = ToMetalRoughness(material.maps, material.convention, {}, 1);
  return material;
}

// MaterialX and Blender mix two lobes and glTF has a clear coat; USD has one lobe, and its figure
// says what that costs.
TEST(MaterialFormatsTest, TwoLobesAreKeptWhereTheFormatHasThem) {
  for (const double coat_f0 : {0.0, 0.04}) {
    const ExportedMaterial material = TwoLobes(coat_f0);
    for (const MaterialFormat& format : MaterialFormats()) {
      const Shading shading = [&](size_t texel, const DirectionPair& pair) {
        return format.brdf(material, texel, pair);
      };
      const double error = ShadingErrors(material.maps, material.convention, {shading}, 1)[0];
      if (format.name != "usd") {
        EXPECT_LT(error, 0.06) << format.name << coat_f0;
      } else {
        EXPECT_GT(error, 0.06) << coat_f0;
        EXPECT_LT(error, 0.25) << coat_f0;
      }
    }
  }
}

TEST(MaterialFormatsTest, ACoatHasItsOwnF0InMaterialXAndBlender) {
  EXPECT_THAT(Format("materialx").write(TwoLobes(0.04), FileOfMap, 1),
              HasSubstr("name=\"color0\" type=\"color3\" value=\"0.04, 0.04, 0.04\""));
  const test::TemporaryFolder folder;
  const std::filesystem::path script = folder / "material.py";
  test::WriteAll(script, Format("blender").write(TwoLobes(0.04), FileOfMap, 1));
  EXPECT_THAT(test::ReadAll(script), HasSubstr("COAT_F0 = 0.04 "));
  const test::Outcome run =
      test::RunProgram({"python3", GLINT_STAND_IN_BPY, script.string(), "material"});
  EXPECT_EQ(run.code, 0) << run.err;
}

TEST(MaterialFormatsTest, MaterialXAndBlenderMixTwoLobes) {
  const std::string materialx = Format("materialx").write(TwoLobes(), FileOfMap, 1);
  EXPECT_THAT(materialx, HasSubstr("generalized_schlick_bsdf name=\"narrow\""));
  EXPECT_THAT(materialx, HasSubstr("name=\"mix\" type=\"float\" value=\"0.5\""));
  EXPECT_THAT(materialx, HasSubstr("value=\"1.58114\""));  // 0.4 to the power of −½
  const test::TemporaryFolder folder;
  const std::filesystem::path script = folder / "material.py";
  test::WriteAll(script, Format("blender").write(TwoLobes(), FileOfMap, 1));
  EXPECT_THAT(test::ReadAll(script),
              HasSubstr("LOBE_SCALES, NARROW_SHARE = (1.58114, 0.632456), 0.5"));
  const test::Outcome run =
      test::RunProgram({"python3", GLINT_STAND_IN_BPY, script.string(), "material"});
  EXPECT_EQ(run.code, 0) << run.err;
}

TEST(MaterialFormatsTest, AMirrorsFidelityIsFinite) {
  ExportedMaterial material = test::MaterialOf(test::UniformMaps(kValues));
  for (float& roughness : material.maps.plane(kRoughness)) roughness = 0;
  for (const MaterialFormat& format : MaterialFormats()) {
    const auto brdf = format.brdf(material, 0, MakePair({0, 0, 1}, {0, 0, 1}));
    for (const double value : brdf) EXPECT_TRUE(std::isfinite(value)) << format.name;
  }
}

ExportedMaterial Anisotropic(double narrow_share = 0) {
  ExportedMaterial material = test::MaterialOf(test::UniformMaps(kValues));
  material.convention.lobes.anisotropy = {2.25, 30};
  material.convention.lobes.narrow_share = narrow_share;
  material.convention.lobes.narrow_ratio = 0.4;
  material.metal = ToMetalRoughness(material.maps, material.convention, {}, 1);
  return material;
}

// USD's preview surface has round lobes alone, and its figure says what that costs.
TEST(MaterialFormatsTest, AnisotropyIsKeptWhereTheFormatHasIt) {
  const ExportedMaterial material = Anisotropic();
  for (const MaterialFormat& format : MaterialFormats()) {
    const Shading shading = [&](size_t texel, const DirectionPair& pair) {
      return format.brdf(material, texel, pair);
    };
    const double error = ShadingErrors(material.maps, material.convention, {shading}, 1)[0];
    if (format.name != "usd") {
      EXPECT_LT(error, 0.06) << format.name;
    } else {
      EXPECT_GT(error, 0.06);
    }
  }
}

TEST(MaterialFormatsTest, MaterialXAndBlenderTurnTheTangent) {
  for (const double narrow_share : {0.0, 0.5}) {
    const std::string materialx =
        Format("materialx").write(Anisotropic(narrow_share), FileOfMap, 1);
    EXPECT_THAT(materialx, HasSubstr("value=\"1.5, 0.666667\""));
    EXPECT_THAT(materialx, HasSubstr("name=\"tangent\" type=\"vector3\" nodename=\"along\""));
    EXPECT_THAT(materialx, HasSubstr("value=\"0.866025\""));  // the tangent's part: cos 30°
    const test::TemporaryFolder folder;
    const std::filesystem::path script = folder / "material.py";
    test::WriteAll(script, Format("blender").write(Anisotropic(narrow_share), FileOfMap, 1));
    EXPECT_THAT(test::ReadAll(script),
                HasSubstr("ANISOTROPY, ANISOTROPY_TURN = -0.333333, 0.0833333"));
    const test::Outcome run =
        test::RunProgram({"python3", GLINT_STAND_IN_BPY, script.string(), "material"});
    EXPECT_EQ(run.code, 0) << run.err;
  }
}

// Together and by several threads as each by itself.
TEST(MaterialFormatsTest, ShadingErrorsAreEachShadingsOwn) {
  const ExportedMaterial material = test::MaterialOf(test::UniformMaps(kValues));
  std::vector<Shading> shadings = {MetalRoughnessShading(material.metal, material.maps)};
  for (const MaterialFormat& format : MaterialFormats()) {
    shadings.push_back([&](size_t texel, const DirectionPair& pair) {
      return format.brdf(material, texel, pair);
    });
  }
  const auto together = ShadingErrors(material.maps, material.convention, shadings, 3);
  ASSERT_EQ(together.size(), shadings.size());
  for (size_t i = 0; i < shadings.size(); ++i) {
    EXPECT_EQ(together[i], ShadingErrors(material.maps, material.convention, {shadings[i]}, 1)[0]);
  }
}

TEST(MaterialFormatsTest, RefusesAFormatThatIsNone) {
  EXPECT_THROW(ChosenFormats({"gltf", "obj"}), UserError);
  EXPECT_EQ(ChosenFormats({"usd", "gltf"}).size(), 2u);
  EXPECT_EQ(ChosenFormats({}).size(), MaterialFormats().size());
}

}  // namespace
}  // namespace glint
