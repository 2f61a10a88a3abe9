// The sections of the page, top to bottom.
#pragma once

#include <string>
#include <vector>

#include "base/images/image.h"
#include "pipeline/report/report.h"
#include "pipeline/report/shown_views.h"

namespace glint {

// The page's head: size, number of photographs, where the maps are.
std::string TitleSection(const ReportInput& input);
// A part of the page that is closed at first.
std::string Folded(const std::string& title, const std::string& body);

// Standard deviation of the roughness in colours from 0 to 0.2, at most `most_px` along a side.
Image RoughnessConfidence(const ReportInput& input, const std::filesystem::path& confidence_exr,
                          int most_px);

std::string OverviewSection(const ReportInput& input, const Json& own_metrics);
std::string MapsSection(const ReportInput& input, const ReportOptions& options);
// Three by three repetitions; "" where the stage tile has not run on these maps.
std::string TileSection(const ReportInput& input, const ReportOptions& options);
// Adds the errors to `own_metrics`.
std::string ViewsSection(const ReportInput& input, const std::vector<ShownView>& shown,
                         Json* own_metrics);
std::string GeometrySection(const ReportInput& input);
// Metrics, pictures, options, inputs and outputs of one stage.
std::string StageSection(const ReportInput& input, const std::string& stage);

}  // namespace glint
