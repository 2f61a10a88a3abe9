#include "datasets/procedural/material.h"

#include <optional>
#include <stdexcept>

#include "datasets/procedural/blend.h"
#include "datasets/procedural/families/families.h"
#include "datasets/procedural/random.h"
#include "datasets/procedural/surface.h"

namespace glint {
namespace {

using procedural::AllFamilies;
using procedural::Family;
using procedural::Mix64;
using procedural::Rng;

constexpr int kLargestSide = 8192;
constexpr float kBlendShare = 0.3f;
constexpr float kFinishedShare = 0.95f;
// Streams of one seed that must not repeat each other's draws.
constexpr uint64_t kRecipeStream = 0x7265636970650001ull;
constexpr uint64_t kFirstStream = 0x6669727374000002ull;
constexpr uint64_t kSecondStream = 0x7365636f6e640003ull;
constexpr uint64_t kMaskStream = 0x6d61736b00000004ull;
constexpr uint64_t kFinishStream = 0x66696e6973680005ull;
constexpr uint64_t kReconcileStream = 0x7265636f6e630006ull;

const Family& DrawFamily(Rng& rng) {
  float total = 0.0f;
  for (const Family& family : AllFamilies()) total += family.weight;
  float left = rng.Unit() * total;
  for (const Family& family : AllFamilies()) {
    left -= family.weight;
    if (left < 0.0f) return family;
  }
  return AllFamilies().back();
}

const Family& FindFamily(const std::string& name) {
  std::string known;
  for (const Family& family : AllFamilies()) {
    if (family.name == name) return family;
    known += (known.empty() ? "" : ", ") + std::string(family.name);
  }
  throw std::invalid_argument("unknown material family \"" + name + "\"; known are " + known);
}

// The stream of one family: the same seed draws unrelated parameters in another one.
uint64_t FamilySeed(const Family& family, uint64_t seed, uint64_t stream) {
  uint64_t hash = seed ^ stream;
  for (const char c : family.name) hash = Mix64(hash ^ static_cast<unsigned char>(c));
  return hash;
}

SvbrdfMaps MakeOne(const MaterialRecipe& recipe, const std::string& name, uint64_t stream,
                   int width, int height) {
  const Family& family = FindFamily(name);
  const uint64_t seed = FamilySeed(family, recipe.seed, stream);
  std::optional<uint64_t> finish;
  if (recipe.finished) finish = Mix64(seed ^ kFinishStream);
  return procedural::MakeSurface(family, seed, finish, width, height);
}

void CheckSize(int width, int height) {
  if (width >= 1 && height >= 1 && width <= kLargestSide && height <= kLargestSide) return;
  throw std::invalid_argument(
      "a material of " + std::to_string(width) + "×" + std::to_string(height) +
      " texels was asked for; both sides must be 1 to " + std::to_string(kLargestSide));
}

}  // namespace

std::vector<std::string> MaterialFamilies() {
  std::vector<std::string> names;
  for (const Family& family : AllFamilies()) names.emplace_back(family.name);
  return names;
}

bool IsWoodOrPaint(const std::string& family) { return FindFamily(family).wood_or_paint; }

MaterialRecipe DrawRecipe(uint64_t seed) {
  Rng rng(seed ^ kRecipeStream);
  MaterialRecipe recipe;
  recipe.seed = seed;
  recipe.family = DrawFamily(rng).name;
  if (rng.Chance(kBlendShare)) recipe.second = DrawFamily(rng).name;
  recipe.finished = rng.Chance(kFinishedShare);
  return recipe;
}

SvbrdfMaps MakeMaterial(const MaterialRecipe& recipe, int width, int height) {
  CheckSize(width, height);
  SvbrdfMaps first = MakeOne(recipe, recipe.family, kFirstStream, width, height);
  if (recipe.second.empty()) return first;
  SvbrdfMaps second = MakeOne(recipe, recipe.second, kSecondStream, width, height);
  procedural::Reconcile(Mix64(recipe.seed ^ kReconcileStream), first, &second);
  const procedural::Plane mask = procedural::DrawBlendMask(Mix64(recipe.seed ^ kMaskStream), first);
  return procedural::BlendMaterials(std::move(first), second, mask);
}

SvbrdfMaps MakeMaterial(uint64_t seed, int width, int height) {
  return MakeMaterial(DrawRecipe(seed), width, height);
}

SvbrdfMaps MakeMaterial(const std::string& family, uint64_t seed, int width, int height) {
  return MakeMaterial(MaterialRecipe{seed, family, "", false}, width, height);
}

}  // namespace glint
