// glint-import: views that another program rectified become a capture that starts at fit.
#include <fmt/format.h>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/programs/program.h"
#include "calib/guidance/rectified_guidance.h"
#include "datasets/import/import_set.h"
#include "datasets/import/register_set.h"
#include "rectify/views/rectify_capture.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

// Throws when another capture.toml would be lost.
void RequireReplaceable(const fs::path& file, const std::string& text, bool force) {
  std::error_code error;
  if (force || !fs::exists(file, error) || ReadTextFile(file) == text) return;
  throw UserError(file, "", "another capture",
                  "import into a new folder, or use --force to overwrite it");
}

ProgramResult Summarise(const fs::path& folder, const ForeignSet& foreign,
                        const ImportSummary& summary) {
  const RectifiedSet& set = summary.set;
  ProgramResult result;
  result.text = fmt::format("import: {}: {} views of {}x{} texels, {:g} x {:g} mm\n  {}\n",
                            ForeignLayoutName(foreign.layout), set.views.size(), set.plane.width,
                            set.plane.height, set.plane.width_mm, set.plane.height_mm,
                            ToString(set.convention));
  const Vec3d& power = set.views[0].view.light_rgb;
  result.text +=
      fmt::format("  light power {:.6g}, {:.6g}, {:.6g} ({})\n", power[0], power[1], power[2],
                  set.light_power_known ? "known" : "a first guess, fitted with the maps");
  result.text += RegistrationText(summary.metrics["registration"]);
  for (size_t i = 0; i < set.views.size(); ++i) {
    const Json& metrics = summary.metrics["views"][i];
    result.text +=
        fmt::format("  {}  {:<20} usable {:5.1f} %  saturated {:4.1f} %\n", set.views[i].name,
                    set.views[i].photo, 100 * metrics["usable"].get<double>(),
                    100 * metrics["saturated"].get<double>());
  }
  const Verdict verdict = JudgeRectifiedSet(set);
  result.text += TextOf(verdict);
  result.text += "continue with: glint run " + folder.string() + "\n";
  result.json = {{"stage", "rectify"},
                 {"up_to_date", false},
                 {"manifest", set.manifest_file.string()},
                 {"metrics", summary.metrics},
                 {"guidance", ToJson(verdict)}};
  return result;
}

ProgramResult Run(const fs::path& source, const fs::path& folder, const OptionSet& set,
                  const ImportOptions& options, const CommonOptions& common) {
  ForeignSet foreign = ReadForeignSet(source);
  ApplyOptions(options, &foreign);
  const std::string toml = ImportedCaptureToml(foreign, ImportedPlane(foreign, options));
  const fs::path toml_file = folder / "capture.toml";
  RequireReplaceable(toml_file, toml, common.force);
  Stage stage(folder / "glint" / "rectify", {"rectify", kRectifyVersion}, set, common,
              ImportInputs(foreign));
  ProgramResult result{
      stage.UpToDateText(),
      {{"stage", "rectify"}, {"up_to_date", true}, {"manifest", stage.manifest_file().string()}}};
  if (!stage.UpToDate()) {
    result = Summarise(folder, foreign, ImportSet(foreign, options, common, &stage));
  }
  if (!fs::exists(toml_file) || ReadTextFile(toml_file) != toml) {
    WriteFileAtomically(toml_file, toml);
  }
  return result;
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) {
  std::filesystem::path source, folder;
  glint::ImportOptions options;
  glint::OptionSet set;
  set.AddPositional(
      "source", &source,
      "folder or file of the set: views.json, a MaterialGAN folder, or the paper's .wlv file",
      true);
  set.AddPositional("capture", &folder, "folder to write the capture to", true);
  glint::AddImportOptions(&set, &options);
  const glint::ProgramInfo info{
      "glint-import",
      "Makes a capture from views rectified by another program; glint run continues with fit.\n"
      "docs/views.md describes the layouts.",
      GLINT_VERSION,
      "Examples:\n  glint import materialgan/cards-blue cards --size 512\n"
      "  glint import scans/views.json scan --light-power estimate"};
  return glint::RunProgram(argc, argv, info, &set, [&](const glint::CommonOptions& common) {
    return glint::Run(source, folder, set, options, common);
  });
}
