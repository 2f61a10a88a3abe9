#include "fitting/view_correction/view_correction.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include "base/model/solver.h"
#include "base/model/view_correction.h"
#include "base/parallel/parallel.h"
#include "fitting/view_correction/bounded_step.h"
#include "fitting/view_correction/sampled_texels.h"
#include "fitting/view_correction/view_priors.h"
#include "fitting/view_correction/view_unknowns.h"

namespace glint {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

int SampledCount(int wanted, size_t views) {
  const double share = std::min(1.0, constants::kViewsOfAllTexels / static_cast<double>(views));
  return std::max(std::min(wanted, constants::kFewestCorrectionTexels),
                  static_cast<int>(wanted * share * share));
}

// Some sampled texels and the descent of the views on them.
class Adjustment {
 public:
  Adjustment(const PhotographSet& set, const SvbrdfMaps& maps, const ViewCorrectionOptions& options,
             bool registration, int texels, int threads)
      : options_(options),
        unknowns_(set, {options.light, options.exposure, registration, options.environment_terms}),
        sampled_(set, maps, unknowns_, texels, options.robust_scale, threads),
        expected_(options.expected),
        x_(VectorXd::Zero(unknowns_.size())) {}
  Adjustment(const Adjustment&) = delete;  // its parts refer to each other
  Adjustment& operator=(const Adjustment&) = delete;

  // Residuals expected, and the effective sample size of a view's.
  void Weigh(double sigma, double effective_residuals);
  // From where it stands, until a step gains less than `tolerance` of the cost.
  void Descend(double tolerance);
  // Expects offsets like those found.
  void Learn();
  void BeginWith(const ViewCorrections& known) { MoveTo(unknowns_.Of(known)); }
  // To the texels' best at `x`.
  void MoveTo(const VectorXd& x);
  // Cost of texels fitted to the views as they were, from their starts or from where they are now.
  double CostUncorrected();

  const VectorXd& x() const { return x_; }
  bool empty() const { return sampled_.size() == 0; }
  double cost() const { return cost_; }
  double RoundingCost() const {
    return 0.5 * sampled_.residuals() * constants::kRoundingSigma * constants::kRoundingSigma;
  }
  double residual_rms() const { return std::sqrt(2 * cost_ / sampled_.residuals()); }
  double SharedNoise() { return sampled_.SharedNoise(x_, values_); }
  ViewCorrections Corrections() const { return unknowns_.CorrectionsAt(x_); }
  SystematicDeviations PropagatedDeviations();

 private:
  ViewPriors Priors() const { return ViewPriors(unknowns_, expected_, sampled_.UsableViews()); }
  double PriorCost(const VectorXd& x, const SampledTexels::Values& values) const;
  NormalEquations Equations();
  std::vector<bool> Free() const;
  // Views that no texel is seen in stay as they are.
  void FixUnseen(NormalEquations* equations) const;
  VectorXd Step(NormalEquations equations, double damping) const;

  const ViewCorrectionOptions& options_;
  ViewUnknowns unknowns_;
  SampledTexels sampled_;
  ViewExpectations expected_;
  VectorXd x_;
  SampledTexels::Values values_;
  double cost_ = 0;    // of the texels
  double weight_ = 1;  // of that, against the expectations
};

void Adjustment::Weigh(double sigma, double effective_residuals) {
  sampled_.SetResidualSigma(sigma);
  const double of_a_view = 3.0 * sampled_.size();
  weight_ = std::min(1.0, effective_residuals / of_a_view) / (sigma * sigma);
  MoveTo(x_);
}

void Adjustment::MoveTo(const VectorXd& x) {
  x_ = x;
  if (values_.empty()) values_ = sampled_.Starts();
  cost_ = sampled_.Fit(x_, nullptr, &values_);
}

double Adjustment::CostUncorrected() {
  const VectorXd none = VectorXd::Zero(x_.size());
  SampledTexels::Values values = sampled_.Starts();
  return sampled_.Fit(none, &values_, &values);
}

void Adjustment::Learn() { expected_ = Priors().Learned(x_, options_.expected); }

double Adjustment::PriorCost(const VectorXd& x, const SampledTexels::Values& values) const {
  const double level = sampled_.MeanSlope(values).norm() / expected_.level;
  return Priors().Add(x, nullptr) + 0.5 * level * level;
}

NormalEquations Adjustment::Equations() {
  NormalEquations equations = sampled_.Reduce(x_, values_);
  equations.hessian *= weight_;
  equations.gradient *= weight_;
  Priors().Add(x_, &equations);
  const MatrixXd by = sampled_.MeanSlopeByViews() / expected_.level;
  equations.hessian.noalias() += by.transpose() * by;
  equations.gradient.noalias() += by.transpose() * (sampled_.MeanSlope(values_) / expected_.level);
  return equations;
}

std::vector<bool> Adjustment::Free() const {
  std::vector<bool> free(static_cast<size_t>(unknowns_.size()), true);
  const auto freeze = [&](int first, int count) {
    std::fill_n(free.begin() + first, count, false);
  };
  const UnknownKinds& kinds = unknowns_.kinds();
  const std::vector<bool> usable = sampled_.UsableViews();
  for (int v = 0; v < unknowns_.views(); ++v) {
    if (usable[static_cast<size_t>(v)]) continue;
    if (kinds.light) freeze(unknowns_.light(v), 3);
    if (kinds.exposure) freeze(unknowns_.exposure(v), 1);
    if (kinds.registration) freeze(unknowns_.shift(v), 8);
  }
  return free;
}

void Adjustment::FixUnseen(NormalEquations* equations) const {
  const std::vector<bool> free = Free();
  for (int i = 0; i < unknowns_.size(); ++i) {
    if (free[static_cast<size_t>(i)]) continue;
    equations->hessian.row(i).setZero();
    equations->hessian.col(i).setZero();
    equations->hessian(i, i) = 1;
    equations->gradient[i] = 0;
  }
}

SystematicDeviations Adjustment::PropagatedDeviations() {
  NormalEquations equations = Equations();
  FixUnseen(&equations);
  return sampled_.PropagatedDeviations(equations.hessian, values_);
}

VectorXd Adjustment::Step(NormalEquations equations, double damping) const {
  equations.hessian.diagonal().array() +=
      damping * equations.hessian.diagonal().array() + constants::kLeastViewInformation;
  FixUnseen(&equations);
  constexpr double kAny = std::numeric_limits<double>::infinity();
  VectorXd least = VectorXd::Constant(unknowns_.size(), -kAny);
  const VectorXd most = VectorXd::Constant(unknowns_.size(), kAny);
  for (int c = 0; unknowns_.kinds().environment_terms > 0 && c < 3; ++c) {
    least[unknowns_.environment(c)] =
        std::min(unknowns_.LeastEnvironment(c) - x_[unknowns_.environment(c)], 0.0);
  }
  return StepWithin(equations.hessian, -equations.gradient, least, most);
}

void Adjustment::Descend(double tolerance) {
  double total = weight_ * cost_ + PriorCost(x_, values_);
  double damping = constants::kFirstViewDamping;
  std::unique_ptr<NormalEquations> equations;
  for (int i = 0; i < options_.iterations && damping < constants::kMostViewDamping; ++i) {
    if (!equations) equations = std::make_unique<NormalEquations>(Equations());
    const VectorXd step = Step(*equations, damping);
    if (!step.allFinite()) break;
    SampledTexels::Values values = sampled_.Follow(step, values_);
    const double cost = sampled_.Fit(x_ + step, &values_, &values);
    const double after = weight_ * cost + PriorCost(x_ + step, values);
    if (!(after < total)) {
      damping *= constants::kViewDampingRise;
      continue;
    }
    const double gain = (total - after) / total;
    x_ += step;
    values_ = std::move(values);
    cost_ = cost;
    total = after;
    equations.reset();
    damping = std::max(constants::kViewDampingFall * damping, constants::kLeastViewDamping);
    if (gain < tolerance) break;
  }
}

// Mean over the views.
double NoiseLeft(const ViewCorrections& corrections) {
  double sum = 0;
  for (const ViewCorrection& view : corrections.views) sum += NoiseLeft(view.shifts);
  return sum / static_cast<double>(corrections.views.size());
}

// The last descent: on more texels, with displacements only where they tell, and with more trust
// where all but noise is explained.
ViewCorrectionResult Finish(const PhotographSet& set, const SvbrdfMaps& maps,
                            const ViewCorrectionOptions& options, const Adjustment& coarse,
                            int threads) {
  const double sigma = std::max(constants::kLeastCorrectionSigma, coarse.residual_rms());
  const int texels = SampledCount(options.last_texels, set.photographs.size());
  const auto make = [&](bool registration) {
    auto made = std::make_unique<Adjustment>(set, maps, options, registration, texels, threads);
    made->Weigh(sigma, options.effective_residuals);
    return made;
  };
  std::unique_ptr<Adjustment> fine = make(options.registration);
  fine->MoveTo(coarse.x());
  if (options.registration) {
    std::unique_ptr<Adjustment> unmoved = make(false);
    unmoved->MoveTo(coarse.x().head(unmoved->x().size()));
    const double as_noise = NoiseLeft(fine->Corrections()) * unmoved->cost();
    if (fine->cost() > (1 - options.registration_gain) * as_noise) fine = std::move(unmoved);
  }
  fine->Learn();
  const bool noise = fine->SharedNoise() < constants::kLooksLikeNoise;
  fine->Weigh(std::max(constants::kLeastCorrectionSigma, fine->residual_rms()),
              noise ? options.independent_residuals : options.effective_residuals);
  fine->Descend(constants::kLastTolerance);
  ViewCorrectionResult result;
  result.cost_before = fine->CostUncorrected();
  result.cost_after = fine->cost();
  result.rounding_cost = fine->RoundingCost();
  result.corrections = fine->Corrections();
  result.corrections.systematic_sd = fine->PropagatedDeviations();
  result.noise_left = NoiseLeft(result.corrections);
  return result;
}

// What all views share of a displacement is the place of the maps.
void CentreShifts(std::vector<ViewCorrection>* corrections) {
  const double count = static_cast<double>(corrections->size());
  for (int i = 0; i < 4; ++i) {
    double column = 0, row = 0;
    for (const ViewCorrection& c : *corrections) {
      column += c.shifts.column[i] / count;
      row += c.shifts.row[i] / count;
    }
    for (ViewCorrection& c : *corrections) {
      c.shifts.column[i] -= column;
      c.shifts.row[i] -= row;
    }
  }
}

}  // namespace

std::string ViewCorrectionOptions::Check() const {
  const auto above_zero = [](double sigma) { return sigma > 0; };
  if (!above_zero(expected.light) || !above_zero(expected.distance) ||
      !above_zero(expected.shared_light)) {
    return "the light's expected offsets must be above 0";
  }
  if (!above_zero(expected.level)) return "the sample's expected slope must be above 0";
  if (!above_zero(expected.ambient) || !above_zero(expected.ambient_direction)) {
    return "the expected ambient light must be above 0";
  }
  if (environment_terms < 0 || !AreEnvironmentTerms(static_cast<size_t>(environment_terms))) {
    return "the terms of environment lighting must make up complete degrees";
  }
  if (!above_zero(expected.exposure)) return "the exposures' expected deviation must be above 0";
  if (!above_zero(expected.registration_texel)) {
    return "the expected displacement must be above 0";
  }
  if (!above_zero(effective_residuals) || !above_zero(independent_residuals)) {
    return "effective sample sizes must be above 0";
  }
  if (!(registration_gain >= 0 && registration_gain < 1)) {
    return "the gain required of displacements must be from 0 to 1";
  }
  if (!above_zero(robust_scale)) return "the robust scale must be above 0";
  if (texels < 16 || last_texels < 16) return "at least 16 texels are needed";
  if (iterations < 1) return "at least one iteration is needed";
  return "";
}

ViewCorrectionResult CorrectViews(const PhotographSet& set, const SvbrdfMaps& maps,
                                  const ViewCorrectionOptions& options, int threads,
                                  const ViewCorrections& known) {
  std::string wrong = options.Check();
  if (wrong.empty()) wrong = set.Check();
  if (!wrong.empty()) throw std::invalid_argument("view correction: " + wrong);
  if (maps.width != set.plane.width || maps.height != set.plane.height) {
    throw std::invalid_argument("view correction: the maps' size is not the photographs'");
  }
  if (!known.views.empty() && known.views.size() != set.photographs.size()) {
    throw std::invalid_argument("view correction: as many corrections as photographs are needed");
  }
  Adjustment coarse(set, maps, options, options.registration,
                    SampledCount(options.texels, set.photographs.size()), threads);
  ViewCorrectionResult result;
  result.corrections.views.resize(set.photographs.size());
  if (coarse.empty()) return result;
  coarse.Weigh(constants::kFirstCorrectionSigma, options.effective_residuals);
  if (known.views.empty()) {
    coarse.Descend(constants::kFirstTolerance);
  } else {
    coarse.BeginWith(known);
  }
  coarse.Learn();
  coarse.Weigh(std::max(constants::kLeastCorrectionSigma, coarse.residual_rms()),
               options.effective_residuals);
  coarse.Descend(constants::kSecondTolerance);
  result = Finish(set, maps, options, coarse, threads);
  if (options.registration) CentreShifts(&result.corrections.views);
  return result;
}

View CorrectedView(View view, const ViewCorrection& correction) {
  for (size_t k = 0; k < 3; ++k) {
    view.light_in_sample_mm[k] += correction.light_offset_mm[k];
  }
  view.exposure *= correction.exposure;
  return view;
}

PhotographSet Corrected(PhotographSet set, const ViewCorrections& corrections, int threads) {
  if (corrections.views.size() != set.photographs.size()) {
    throw std::invalid_argument("view correction: as many corrections as photographs are needed");
  }
  ForEachPiece(static_cast<int>(set.photographs.size()), threads, [&](int piece) {
    const size_t i = static_cast<size_t>(piece);
    Photograph& photograph = set.photographs[i];
    const ViewCorrection& c = corrections.views[i];
    photograph.view = CorrectedView(photograph.view, c);
    if (!c.shifts.any()) return;
    const PictureRows rows{set.plane.whole.first_row, set.plane.whole_height()};
    ShiftPicture(c.shifts, set.plane.width, set.plane.height, &photograph.rgb, rows);
    ShiftMask(c.shifts, set.plane.width, set.plane.height, &photograph.mask, rows);
  });
  set.environment.Add(corrections.environment);
  set.systematic_sd = corrections.systematic_sd;
  return set;
}

int RowsReached(const ViewCorrections& corrections) {
  int most = 0;
  for (const ViewCorrection& c : corrections.views) most = std::max(most, RowsReached(c.shifts));
  return most;
}

ViewCorrections AtSize(ViewCorrections corrections, int from_width, int from_height, int to_width,
                       int to_height) {
  for (ViewCorrection& c : corrections.views) {
    for (int i = 0; i < 4; ++i) {
      c.shifts.column[i] *= static_cast<double>(to_width) / from_width;
      c.shifts.row[i] *= static_cast<double>(to_height) / from_height;
    }
  }
  return corrections;
}

double LightTurnedDeg(const View& view, const ViewCorrection& correction) {
  const Vec3d& a = view.light_in_sample_mm;
  Vec3d b;
  for (size_t i = 0; i < 3; ++i) b[i] = a[i] + correction.light_offset_mm[i];
  const double cosine = (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) /
                        (std::hypot(a[0], a[1], a[2]) * std::hypot(b[0], b[1], b[2]));
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / 3.14159265358979323846;
}

}  // namespace glint
