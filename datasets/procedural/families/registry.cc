#include "datasets/procedural/families/families.h"

namespace glint::procedural {
namespace {

// To add a family: its function in families.h and its line here.
// name, parameters, slope from, to, share, directional, wood or paint
constexpr Family kFamilies[] = {
    {"stone", DrawStone, 0.04f, 0.9f, 1.2f, true},
    {"marble", DrawMarble, 0.01f, 0.12f, 1.0f, false},
    {"terrazzo", DrawTerrazzo, 0.01f, 0.2f, 0.8f, false},
    {"gravel", DrawGravel, 0.15f, 1.1f, 1.0f, false},
    {"cracks", DrawCracks, 0.06f, 0.9f, 1.0f, true},
    {"plaster", DrawPlaster, 0.05f, 0.8f, 1.0f, true},
    {"bricks", DrawBricks, 0.06f, 0.8f, 1.2f, true},
    {"tiles", DrawTiles, 0.03f, 0.5f, 1.2f, true},
    {"paving", DrawPaving, 0.08f, 0.8f, 1.2f, true},
    {"wood", DrawWood, 0.01f, 0.25f, 1.2f, true, true},
    {"planks", DrawPlanks, 0.02f, 0.4f, 1.0f, true, true},
    {"bark", DrawBark, 0.15f, 1.2f, 0.8f, true},
    {"weave", DrawWeave, 0.06f, 0.8f, 1.4f, true},
    {"knit", DrawKnit, 0.15f, 1.0f, 0.7f, true},
    {"fibres", DrawFibres, 0.08f, 0.9f, 0.9f, true},
    {"leather", DrawLeather, 0.04f, 0.6f, 1.2f, true},
    {"scales", DrawScales, 0.08f, 0.8f, 0.7f, true},
    {"crumple", DrawCrumple, 0.08f, 0.7f, 0.8f, false},
    {"stripes", DrawStripes, 0.03f, 0.7f, 0.9f, true, true},
    {"dots", DrawDots, 0.04f, 0.8f, 0.9f, true},
    {"stamps", DrawStamps, 0.04f, 0.6f, 1.0f, true},
    {"damask", DrawDamask, 0.03f, 0.6f, 0.9f, true},
    {"brushed", DrawBrushed, 0.01f, 0.2f, 1.0f, true},
    {"scratched", DrawScratched, 0.02f, 0.3f, 1.0f, false},
    {"flakes", DrawFlakes, 0.03f, 0.4f, 0.8f, false},
    {"plates", DrawPlates, 0.03f, 0.6f, 0.9f, true},
    {"smooth", DrawSmooth, 0.005f, 0.4f, 1.2f, false},
    {"rust", DrawRust, 0.03f, 0.6f, 1.0f, true},
    {"peeling_paint", DrawPeelingPaint, 0.04f, 0.6f, 1.0f, true, true},
    {"stains", DrawStains, 0.02f, 0.4f, 1.0f, false},
    {"grass", DrawGrass, 0.1f, 0.7f, 1.0f, false},
    {"litter", DrawLitter, 0.1f, 0.9f, 0.8f, false},
    {"chipboard", DrawChipboard, 0.01f, 0.3f, 0.8f, false, true},
    {"impasto", DrawImpasto, 0.04f, 0.6f, 0.7f, false, true},
    {"moss", DrawMoss, 0.1f, 0.9f, 1.0f, false},
    {"soil", DrawSoil, 0.1f, 0.9f, 1.2f, false},
    {"asphalt", DrawAsphalt, 0.06f, 0.8f, 1.0f, false},
    {"sand", DrawSand, 0.03f, 0.6f, 0.8f, false},
    {"formwork", DrawFormwork, 0.02f, 0.4f, 1.0f, true},
    {"ice", DrawIce, 0.01f, 0.4f, 0.6f, false},
    {"corrugated", DrawCorrugated, 0.05f, 0.9f, 0.8f, true},
    {"tread", DrawTread, 0.04f, 0.5f, 0.6f, true},
    {"hammered", DrawHammered, 0.04f, 0.5f, 0.7f, false},
    {"perforated", DrawPerforated, 0.05f, 0.6f, 0.6f, true},
    {"quilted", DrawQuilted, 0.06f, 0.7f, 0.7f, true},
    {"pile", DrawPile, 0.1f, 0.9f, 0.9f, false},
};

}  // namespace

std::span<const Family> AllFamilies() { return kFamilies; }

}  // namespace glint::procedural
