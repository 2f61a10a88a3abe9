#include "datasets/synth/material_source.h"

#include <charconv>
#include <filesystem>
#include <stdexcept>

#include "base/errors/errors.h"
#include "base/formats/svbrdf_file.h"
#include "datasets/map_formats/read_maps.h"
#include "datasets/procedural/material.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kProcedural = "procedural:";
constexpr int kProceduralSize = 1024;

std::uint64_t ParseSeed(const std::string& text, const std::string& whole) {
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error == std::errc() && end == text.data() + text.size()) return seed;
  throw UserError("material: found \"" + whole +
                  "\"; write procedural:SEED or procedural:FAMILY:SEED with a whole number");
}

MaterialSource MakeProcedural(const std::string& whole, int size) {
  const std::string text = whole.substr(kProcedural.size());
  const size_t colon = text.find(':');
  const int side = size > 0 ? size : kProceduralSize;
  try {
    if (colon == std::string::npos) {
      return {"procedural_" + text, MakeMaterial(ParseSeed(text, whole), side, side)};
    }
    const std::string family = text.substr(0, colon), seed = text.substr(colon + 1);
    return {family + "_" + seed, MakeMaterial(family, ParseSeed(seed, whole), side, side)};
  } catch (const std::invalid_argument& error) {
    throw UserError("material: " + std::string(error.what()));
  }
}

// Name of the file, or of the folder for files whose names say nothing.
std::string NameOf(const fs::path& path) {
  const fs::path whole = fs::absolute(path).lexically_normal();
  fs::path named = whole;
  if (named.filename() == "svbrdf.exr" || !named.has_filename()) named = named.parent_path();
  std::string name = named.stem().string();
  for (char& c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!plain && c != '-' && c != '.') c = '_';
  }
  return name.empty() ? "maps" : name;
}

}  // namespace

MaterialSource LoadMaterial(const std::string& text, int size) {
  if (text.starts_with(kProcedural)) return MakeProcedural(text, size);
  const fs::path path(text);
  MaterialSource source;
  source.name = NameOf(path);
  const fs::path exr = fs::is_directory(path) ? path / "svbrdf.exr" : path;
  if (exr.extension() == ".exr" && fs::exists(exr)) {
    ReflectanceConvention convention;
    source.maps = ReadSvbrdf(exr, &convention);
    source.maps = ToUnitWeight(std::move(source.maps), convention);
  } else {
    source.maps = ReadMaps(path);
  }
  if (size > 0 && (source.maps.width != size || source.maps.height != size)) {
    source.maps = ResampleSvbrdf(source.maps, size, size);
  }
  return source;
}

std::vector<std::string> ReservedMaterials(int count) {
  std::vector<std::string> materials;
  for (int i = 0; i < count; ++i) {
    materials.push_back(std::string(kProcedural) +
                        std::to_string(kReservedSeedBase + static_cast<std::uint64_t>(i)));
  }
  return materials;
}

SvbrdfMaps ToUnitWeight(SvbrdfMaps maps, const ReflectanceConvention& convention) {
  if (convention.diffuse_weight == DiffuseWeight::kOne) return maps;
  for (int c = 0; c < 3; ++c) {
    const auto diffuse = maps.plane(kDiffuseR + c), specular = maps.plane(kSpecularR + c);
    for (size_t i = 0; i < maps.texels(); ++i) diffuse[i] *= 1 - specular[i];
  }
  return maps;
}

}  // namespace glint
