// A camera's tone curve from spots that are seen at several exposures.
//
// A spot of radiance E, exposed t times as much, is stored as v with g(v) = ln E + ln t, where
// g = ln f⁻¹ is what is looked for (P. Debevec and J. Malik 1997, "Recovering High Dynamic Range
// Radiance Maps from Photographs", eq. 2). Their g is 256 unknowns with a smoothness term, which
// may fall; here g is built so that it always rises:
//
//   g(v) = −∫_v^1 γ(u)/u du,   γ(u) = exp(θ(u)),   θ linear between K knots.
//
// γ is the local gamma d ln f⁻¹/d ln v: 2.2 everywhere for a power law, so that the prior
// "θ changes little from knot to knot" bends toward a plain gamma where nothing was seen. All ln E
// are eliminated in closed form (weighted means); Gauss–Newton solves for θ and, where wanted, for
// small corrections of the exposures, which cameras round. Residuals are weighted by the noise of
// the stored values and made robust (Huber).
#pragma once

#include <string>
#include <vector>

namespace glint {

struct ResponseObservation {
  int spot = 0;       // index of a spot of constant radiance
  int exposure = 0;   // index into ResponseProblem::exposures
  double stored = 0;  // mean stored value, 0 … 1
};

// Grey patches under even light are the same problem: a photograph is the spot, and the patches'
// reflectances are the exposures.
struct ResponseProblem {
  std::vector<double> exposures;  // relative, greater than 0
  int spots = 0;
  std::vector<ResponseObservation> observations;
};

struct ResponseOptions {
  int knots = 16;
  double usual_gamma = 2.2, gamma_sigma = 1.0;  // prior of each θ: ln 2.2 ± 1, hardly felt
  double bend_sigma = 0.15;                     // prior of the second differences of θ
  double exposure_sigma = 0.02;  // prior of the corrections of ln t; 0: exposures are exact
  double stored_sigma = 1.5 / 255;
  double lowest = 0.02, highest = 0.98;  // stored values outside are clipped or drowned
  int max_iterations = 60;
};

struct ResponseEstimate {
  std::vector<float> linear;        // of the 256 codes: 0 … 1, rising
  std::vector<double> exposures;    // as corrected, relative as given
  double rms = 0;                   // residual in stored values, 0 … 1
  double usual_rms = 0;             // the same of the usual gamma, exposures as told
  double lowest = 0, highest = 0;   // stored values that were seen
  int observations = 0, spots = 0;  // that had a say: spots seen at two exposures at least
  double span = 0;                  // largest by smallest exposure among them
  double sigma = 0;  // largest relative standard deviation of f⁻¹(v)/f⁻¹(0.5), where v was seen
};

// Throws ComputationError: too few spots seen at several exposures (says how many are needed).
ResponseEstimate EstimateResponse(const ResponseProblem& problem,
                                  const ResponseOptions& options = {});

}  // namespace glint
