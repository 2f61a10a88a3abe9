// One HTML file that shows a whole result: the material to relight and to compare with its
// photographs, maps, re-renderings, cameras, lights, calibration residuals, loss curves, options.
// Everything is inside the file and nothing is loaded; without JavaScript or WebGL the pictures
// remain. Every number carries the manifest and field it comes from (hover over it); those
// that the report computes itself are in its own manifest.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/files/json.h"
#include "base/formats/manifest.h"
#include "base/formats/rectified_set.h"
#include "base/programs/options.h"
#include "datasets/looks/view_error.h"

namespace glint {

inline constexpr int kReportVersion = 13;

struct ReportOptions {
  std::string from = "refine";  // stage whose maps are shown: refine, fit
  int picture_px = 512;         // longest side of a map's picture; views have half of that
  int viewer_px = 1024;         // longest side of the maps that the viewer relights
};

void AddReportOptions(OptionSet* set, ReportOptions* options);

// What the stages left in a capture's glint/ folder.
struct ReportInput {
  std::filesystem::path work;                 // CAPTURE/glint
  std::map<std::string, Manifest> manifests;  // by stage; those that are there, up to `from`
  RectifiedSet set;
  // The same at the size that is shown and compared, at most kMostShownSide along a side, and the
  // maps at that size.
  RectifiedSet shown;
  FittedMaps fit;
  std::vector<std::string> used_views;  // by name: those that the maps were fitted to

  bool Has(const std::string& stage) const { return manifests.count(stage) > 0; }
};

// Manifests of the stages that a report of `from` shows, in order; those absent are left out.
std::vector<std::filesystem::path> ReportManifests(const std::filesystem::path& work,
                                                   const std::string& from);

// Larger maps and photographs are averaged to this size, and never whole in memory. Some 900 MB.
inline constexpr int kMostShownSide = 2048;

// Throws UserError when rectify's or `from`'s result is missing or damaged.
ReportInput ReadReportInput(const std::filesystem::path& work, const std::string& from,
                            int most_side = kMostShownSide);

struct Report {
  std::string html;
  std::string thumbnail_jpeg;
  Json metrics;  // for the report's manifest: errors and looks of the views
};

Report MakeReport(const ReportInput& input, const ReportOptions& options, int threads);

}  // namespace glint
