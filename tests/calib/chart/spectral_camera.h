// Charts as reflectance spectra, seen by cameras whose sensitivities are no combinations of the
// eye's: what no matrix corrects exactly.
#pragma once

#include <string>
#include <vector>

#include "calib/chart/chart.h"
#include "calib/chart/measure_chart.h"

namespace glint::testing {

std::vector<std::string> SpectralFlashes();  // of telephones and cameras; known is "tungsten" too
std::vector<std::string> SpectralCameras();

// Gives the patches smooth reflectances that have their colours under black-body light of 5003 K,
// and puts the colours that these really have (they stay between 0.5 and 100 %) into the chart.
std::vector<Eigen::VectorXd> SmoothReflectances(Chart* chart);

// Linear values, white-balanced, brightest white at 0.85 in the middle; a flash at 1.7 half
// diagonals, noise of 0.5 % and 8 bits of gamma 2.2.
std::vector<PatchReading> SpectralReadings(const Chart& chart,
                                           const std::vector<Eigen::VectorXd>& reflectances,
                                           const std::string& flash, const std::string& camera);

}  // namespace glint::testing
