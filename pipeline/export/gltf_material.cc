#include "pipeline/export/gltf_material.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

#include "base/colour/srgb.h"
#include "base/files/json.h"
#include "base/images/image.h"
#include "base/parallel/parallel.h"
#include "base/reflectance/brdf.h"
#include "pipeline/export/direction_pairs.h"
#include "pipeline/export/export_maps.h"

namespace glint {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

constexpr int kFloat = 5126, kUnsignedShort = 5123;          // glTF's component types
constexpr int kArrayBuffer = 34962, kElementBuffer = 34963;  // and buffer targets

// Bytes that views refer to, each at a multiple of four.
class Buffer {
 public:
  // Index of the view that holds the bytes.
  int Add(std::string_view bytes, int target = 0) {
    bytes_.resize((bytes_.size() + 3) / 4 * 4, '\0');
    Json view = {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}};
    if (target != 0) view["target"] = target;
    views_.push_back(view);
    bytes_ += bytes;
    return static_cast<int>(views_.size()) - 1;
  }
  template <class T>
  int AddValues(const std::vector<T>& values, int target) {
    return Add({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)}, target);
  }
  const std::string& bytes() const { return bytes_; }
  const Json& views() const { return views_; }

 private:
  std::string bytes_;
  Json views_ = Json::array();
};

Image BaseColor(const ExportedMaterial& material) {
  Image image(material.maps.width, material.maps.height, kRgbChannels);
  for (size_t i = 0; i < material.maps.texels(); ++i) {
    const std::array<double, 3> base = GltfBaseColor(material, i);
    for (int c = 0; c < 3; ++c) {
      image.channel(c)[i] = ClampedSrgb(static_cast<float>(base[static_cast<size_t>(c)]));
    }
  }
  return image;
}

// Of the wide lobe, where there are two.
Image OcclusionRoughnessMetallic(const ExportedMaterial& material) {
  const SvbrdfMaps& maps = material.maps;
  Image image(maps.width, maps.height, kRgbChannels);  // blue: metalness 0
  std::fill(image.channel(0).begin(), image.channel(0).end(), 1.0f);
  for (size_t i = 0; i < maps.texels(); ++i) {
    image.channel(1)[i] = static_cast<float>(GltfLobesOf(material, i).roughness);
  }
  return image;
}

// Strength in red, roughness in green.
Image Clearcoat(const ExportedMaterial& material) {
  const SvbrdfMaps& maps = material.maps;
  Image image(maps.width, maps.height, kRgbChannels);
  for (size_t i = 0; i < maps.texels(); ++i) {
    const GltfLobes lobes = GltfLobesOf(material, i);
    image.channel(0)[i] = static_cast<float>(lobes.clearcoat);
    image.channel(1)[i] = static_cast<float>(lobes.clearcoat_roughness);
  }
  return image;
}

Image Normal(const SvbrdfMaps& maps) {
  Image image(maps.width, maps.height, kRgbChannels);
  for (int c = 0; c < 3; ++c) {
    std::transform(maps.plane(kNormalX + c).begin(), maps.plane(kNormalX + c).end(),
                   image.channel(c).begin(), [](float n) { return 0.5f * n + 0.5f; });
  }
  return image;
}

// F0 over the largest of the sample.
Image SpecularColor(const ExportedMaterial& material, float largest) {
  Image image(material.maps.width, material.maps.height, kRgbChannels);
  for (size_t i = 0; i < material.maps.texels(); ++i) {
    const GltfLobes lobes = GltfLobesOf(material, i);
    for (int c = 0; c < 3; ++c) {
      image.channel(c)[i] =
          ClampedSrgb(static_cast<float>(lobes.f0[static_cast<size_t>(c)]) / largest);
    }
  }
  return image;
}

// The tangent in red and green, strength in blue.
Image AnisotropyStrength(const ExportedMaterial& material) {
  const SvbrdfMaps& maps = material.maps;
  Image image(maps.width, maps.height, kRgbChannels);
  std::fill(image.channel(0).begin(), image.channel(0).end(), 1.0f);
  std::fill(image.channel(1).begin(), image.channel(1).end(), 0.5f);
  for (size_t i = 0; i < maps.texels(); ++i) {
    image.channel(2)[i] = static_cast<float>(GltfLobesOf(material, i).anisotropy);
  }
  return image;
}

constexpr int kNormalTexture = 2;

// By the indices of the textures that not every material has.
Json MaterialJson(const ExportedMaterial& exported, float largest_f0,
                  std::optional<int> clearcoat_texture, std::optional<int> anisotropy_texture) {
  const double factor = largest_f0 / kGltfF0;
  Json material = {{"name", exported.name},
                   {"doubleSided", true},
                   {"pbrMetallicRoughness",
                    {{"baseColorTexture", {{"index", 0}}},
                     {"metallicRoughnessTexture", {{"index", 1}}},
                     {"metallicFactor", 0.0}}},
                   {"normalTexture", {{"index", kNormalTexture}}},
                   {"extensions",
                    {{"KHR_materials_specular",
                      {{"specularColorFactor", {factor, factor, factor}},
                       {"specularColorTexture", {{"index", 3}}}}}}}};
  if (clearcoat_texture) {
    material["extensions"]["KHR_materials_clearcoat"] = {
        {"clearcoatFactor", 1.0},
        {"clearcoatTexture", {{"index", *clearcoat_texture}}},
        {"clearcoatRoughnessFactor", 1.0},
        {"clearcoatRoughnessTexture", {{"index", *clearcoat_texture}}},
        {"clearcoatNormalTexture", {{"index", kNormalTexture}}}};
  }
  if (anisotropy_texture) {
    const double direction_deg = exported.convention.lobes.anisotropy.direction_deg;
    material["extensions"]["KHR_materials_anisotropy"] = {
        {"anisotropyStrength", 1.0},
        {"anisotropyRotation", direction_deg * (std::numbers::pi / 180)},
        {"anisotropyTexture", {{"index", *anisotropy_texture}}}};
  }
  return material;
}

// A plane of four corners; texture coordinates run from the upper left.
Json PlaneAccessors(double width_m, double height_m, Buffer* buffer) {
  const auto x = static_cast<float>(width_m / 2), y = static_cast<float>(height_m / 2);
  const std::vector<float> positions = {-x, y, 0, x, y, 0, -x, -y, 0, x, -y, 0};
  const std::vector<float> normals = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
  const std::vector<float> tangents = {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1};
  const std::vector<float> coordinates = {0, 0, 1, 0, 0, 1, 1, 1};
  const std::vector<std::uint16_t> triangles = {0, 2, 1, 1, 2, 3};
  Json accessors = Json::array();
  const auto add = [&](int view, int component, int count, const char* type) {
    accessors.push_back(
        {{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
  };
  add(buffer->AddValues(positions, kArrayBuffer), kFloat, 4, "VEC3");
  accessors[0]["min"] = {-x, -y, 0};
  accessors[0]["max"] = {x, y, 0};
  add(buffer->AddValues(normals, kArrayBuffer), kFloat, 4, "VEC3");
  add(buffer->AddValues(tangents, kArrayBuffer), kFloat, 4, "VEC4");
  add(buffer->AddValues(coordinates, kArrayBuffer), kFloat, 4, "VEC2");
  add(buffer->AddValues(triangles, kElementBuffer), kUnsignedShort, 6, "SCALAR");
  return accessors;
}

void AppendChunk(const char type[4], std::string bytes, char padding, std::string* file) {
  bytes.resize((bytes.size() + 3) / 4 * 4, padding);
  const auto length = static_cast<std::uint32_t>(bytes.size());
  file->append(reinterpret_cast<const char*>(&length), 4);
  file->append(type, 4);
  file->append(bytes);
}

}  // namespace

std::array<double, 3> GltfBaseColor(const ExportedMaterial& material, size_t texel) {
  const SvbrdfMaps& maps = material.maps;
  const GltfLobes lobes = GltfLobesOf(material, texel);
  const double most = *std::max_element(lobes.f0.begin(), lobes.f0.end());
  const double under_both = (1 - most) * (1 - kGltfF0 * lobes.clearcoat);
  const bool whole = material.convention.diffuse_weight == DiffuseWeight::kOne;
  const double left = whole ? std::max(1e-3, under_both) : 1.0;
  std::array<double, 3> base;
  for (int c = 0; c < 3; ++c) {
    base[static_cast<size_t>(c)] = std::clamp(maps.plane(kDiffuseR + c)[texel] / left, 0.0, 1.0);
  }
  return base;
}

GltfLobes GltfLobesOf(const ExportedMaterial& material, size_t texel) {
  const SvbrdfMaps& maps = material.maps;
  GltfLobes lobes;
  for (int c = 0; c < 3; ++c) {
    lobes.f0[static_cast<size_t>(c)] = maps.plane(kSpecularR + c)[texel];
  }
  lobes.roughness = maps.plane(kRoughness)[texel];
  const SpecularLobes& ours = material.convention.lobes;
  const LobeMix<double> mix = LobeMixOf<double>(ours);
  lobes.clearcoat_roughness = LobeRoughness(lobes.roughness, mix, 1);
  lobes.roughness = LobeRoughness(lobes.roughness, mix, 0);
  if (ours.anisotropy.any()) {
    const LobeWidths widths = WidthsOf(lobes.roughness, ours.anisotropy);
    lobes.roughness = std::sqrt(widths.across);
    lobes.anisotropy = std::sqrt((widths.along - widths.across) / (1 - widths.across));
  }
  if (!ours.two()) return lobes;
  if (mix.coat()) {
    lobes.clearcoat = std::min(1.0, mix.share[1] * mix.coat_f0 / kGltfF0);
    for (double& f0 : lobes.f0) f0 *= mix.share[0];
    return lobes;
  }
  const double least = *std::min_element(lobes.f0.begin(), lobes.f0.end());
  const double mean = (lobes.f0[0] + lobes.f0[1] + lobes.f0[2]) / 3;
  lobes.clearcoat = std::min({1.0, ours.narrow_share * mean / kGltfF0, least / kGltfF0});
  for (double& f0 : lobes.f0) f0 -= lobes.clearcoat * kGltfF0;
  return lobes;
}

std::string GlbOf(const ExportedMaterial& material, int threads) {
  const SvbrdfMaps& maps = material.maps;
  float largest = static_cast<float>(kGltfF0);
  for (int c = 0; c < 3; ++c) {
    for (const float f0 : maps.plane(kSpecularR + c)) largest = std::max(largest, f0);
  }
  Buffer buffer;
  const Json accessors =
      PlaneAccessors(material.width_mm / 1000, material.height_mm / 1000, &buffer);
  struct Texture {
    const char* name;
    std::function<Image()> image;
    std::string png;
  };
  std::vector<Texture> of_material = {
      {"basecolor", [&] { return BaseColor(material); }, {}},
      {"occlusion_roughness_metallic", [&] { return OcclusionRoughnessMetallic(material); }, {}},
      {"normal", [&] { return Normal(maps); }, {}},
      {"specularcolor", [&] { return SpecularColor(material, largest); }, {}}};
  const auto add = [&](bool has, const char* name, const std::function<Image()>& image) {
    if (!has) return std::optional<int>();
    of_material.push_back({name, image, {}});
    return std::optional(static_cast<int>(of_material.size()) - 1);
  };
  const SpecularLobes& lobes = material.convention.lobes;
  const auto clearcoat = add(lobes.two(), "clearcoat", [&] { return Clearcoat(material); });
  const auto anisotropy =
      add(lobes.anisotropy.any(), "anisotropy", [&] { return AnisotropyStrength(material); });
  ForEachPiece(static_cast<int>(of_material.size()), threads, [&](int i) {
    Texture& texture = of_material[static_cast<size_t>(i)];
    texture.png = EncodePng(texture.image());
  });
  Json images = Json::array(), textures = Json::array();
  for (const Texture& texture : of_material) {
    textures.push_back({{"source", images.size()}, {"sampler", 0}});
    images.push_back({{"name", material.name + "_" + texture.name},
                      {"mimeType", "image/png"},
                      {"bufferView", buffer.Add(texture.png)}});
  }
  constexpr int kLinear = 9729, kLinearMipmapLinear = 9987, kRepeat = 10497;
  Json extensions = {"KHR_materials_specular"};
  if (clearcoat) extensions.push_back("KHR_materials_clearcoat");
  if (anisotropy) extensions.push_back("KHR_materials_anisotropy");
  const Json json = {
      {"asset", {{"version", "2.0"}, {"generator", "Glint"}}},
      {"extensionsUsed", extensions},
      {"scene", 0},
      {"scenes", {{{"nodes", {0}}}}},
      {"nodes", {{{"mesh", 0}, {"name", material.name}}}},
      {"meshes",
       {{{"name", material.name},
         {"primitives",
          {{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TANGENT", 2}, {"TEXCOORD_0", 3}}},
            {"indices", 4},
            {"material", 0}}}}}}},
      {"materials", {MaterialJson(material, largest, clearcoat, anisotropy)}},
      {"samplers",
       {{{"magFilter", kLinear},
         {"minFilter", kLinearMipmapLinear},
         {"wrapS", kRepeat},
         {"wrapT", kRepeat}}}},
      {"textures", textures},
      {"images", images},
      {"accessors", accessors},
      {"bufferViews", buffer.views()},
      {"buffers", {{{"byteLength", buffer.bytes().size()}}}}};
  std::string chunks;
  AppendChunk("JSON", json.dump(-1, ' ', false, Json::error_handler_t::replace), ' ', &chunks);
  AppendChunk("BIN\0", buffer.bytes(), '\0', &chunks);
  const std::uint32_t header[3] = {0x46546C67u, 2u, static_cast<std::uint32_t>(12 + chunks.size())};
  return std::string(reinterpret_cast<const char*>(header), sizeof header) + chunks;
}

}  // namespace glint
