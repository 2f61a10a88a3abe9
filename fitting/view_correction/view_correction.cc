#include "fitting/view_correction/view_correction.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <stdexcept>

#include "base/parallel/parallel.h"
#include "fitting/reflectance/brdf.h"
#include "fitting/view_correction/holds.h"
#include "fitting/view_correction/radiance_cost.h"

namespace glint {
namespace {

constexpr double kLeastRoughness = 0.02;
constexpr double kSteepest = 6.0;  // slope
constexpr int kMargin = 2;         // texels at the edge, whose lookup would leave the picture

struct ViewBlocks {
  double light[3] = {0, 0, 0};
  double exposure[1] = {0};
  double shifts[8] = {0, 0, 0, 0, 0, 0, 0, 0};
};

struct Texel {
  int column, row;
  double parameters[kTexelSize];
};

class Adjustment {
 public:
  Adjustment(const PhotographSet& set, const SvbrdfMaps& maps,
             const ViewCorrectionOptions& options);
  ViewCorrectionResult Solve();

 private:
  void AddViews();
  void AddTexels();
  void HoldTexels();
  bool AddTexel(Texel* texel);
  Texel TexelAt(int column, int row) const;
  ViewCorrection CorrectionOf(size_t view) const;

  const PhotographSet& set_;
  const SvbrdfMaps& maps_;
  const ViewCorrectionOptions& options_;
  std::vector<ViewContext> contexts_;
  std::vector<ViewBlocks> views_;
  double ambient_[3] = {0, 0, 0};
  double tilt_[2] = {0, 0};
  double shared_light_[3] = {0, 0, 0};  // in every light's frame
  std::deque<Texel> texels_;            // a deque: Ceres keeps addresses
  ceres::Problem problem_;
  ceres::ParameterBlockOrdering* ordering_ = nullptr;
};

Adjustment::Adjustment(const PhotographSet& set, const SvbrdfMaps& maps,
                       const ViewCorrectionOptions& options)
    : set_(set), maps_(maps), options_(options), views_(set.photographs.size()) {
  for (const Photograph& photograph : set.photographs) {
    ViewContext& context = contexts_.emplace_back();
    context.photograph = &photograph;
    context.plane = set.plane;
    context.convention = set.convention;
    const Vec3d& light = photograph.view.light_in_sample_mm;
    context.light_distance_mm = std::hypot(light[0], light[1], light[2]);
    const TexelGeometry<double> centre =
        TexelGeometryInView(photograph.view, set.convention.falloff, 0.0, 0.0);
    context.irradiance = (centre.irradiance[0] + centre.irradiance[1] + centre.irradiance[2]) /
                         (3 * photograph.view.exposure);
    context.weight = 1 / options.residual_sigma;
    context.robust_scale = options.robust_scale;
  }
}

Texel Adjustment::TexelAt(int column, int row) const {
  Texel texel{column, row, {}};
  const auto in = [](double value, double least, double most) {
    return std::clamp(value, least, most);
  };
  for (int c = 0; c < 3; ++c) {
    texel.parameters[kTexelDiffuse + c] = in(maps_.at(kDiffuseR + c, row, column), 0, 1);
    texel.parameters[kTexelSpecular + c] = in(maps_.at(kSpecularR + c, row, column), 0, 1);
  }
  texel.parameters[kTexelRough] = in(maps_.at(kRoughness, row, column), kLeastRoughness, 1);
  const double z = std::max(0.05f, maps_.at(kNormalZ, row, column));
  for (int i = 0; i < 2; ++i) {
    texel.parameters[kTexelSlope + i] =
        in(maps_.at(kNormalX + i, row, column) / z, -kSteepest, kSteepest);
  }
  return texel;
}

bool Adjustment::AddTexel(Texel* texel) {
  const size_t index = static_cast<size_t>(texel->row) * set_.plane.width + texel->column;
  bool seen = false;
  for (size_t v = 0; v < views_.size(); ++v) {
    if (set_.photographs[v].mask[index] < 0.5f) continue;
    seen = true;
    problem_.AddResidualBlock(new RadianceCost(contexts_[v], texel->column, texel->row), nullptr,
                              texel->parameters, views_[v].light, ambient_, views_[v].exposure,
                              views_[v].shifts);
  }
  if (!seen) return false;
  for (int i = 0; i < kTexelSize; ++i) {
    const bool slope = i >= kTexelSlope;
    problem_.SetParameterLowerBound(texel->parameters, i,
                                    slope ? -kSteepest : (i == kTexelRough ? kLeastRoughness : 0));
    problem_.SetParameterUpperBound(texel->parameters, i, slope ? kSteepest : 1);
  }
  ordering_->AddElementToGroup(texel->parameters, 0);
  return true;
}

void Adjustment::AddTexels() {
  const double texels = static_cast<double>(maps_.texels());
  const int stride =
      std::max(1, static_cast<int>(std::lround(std::sqrt(texels / options_.texels))));
  for (int row = kMargin + stride / 2; row < set_.plane.height - kMargin; row += stride) {
    for (int column = kMargin + stride / 2; column < set_.plane.width - kMargin; column += stride) {
      texels_.push_back(TexelAt(column, row));
      if (!AddTexel(&texels_.back())) texels_.pop_back();
    }
  }
}

// Lights that are all wrong alike have tilted all normals; but the sample is flat.
void Adjustment::HoldTexels() {
  double mean[2] = {0, 0};
  for (Texel& texel : texels_) {
    problem_.AddResidualBlock(new TexelHold(texel.parameters), nullptr, texel.parameters, tilt_);
    for (int i = 0; i < 2; ++i) {
      mean[i] -= texel.parameters[kTexelSlope + i] / static_cast<double>(texels_.size());
    }
  }
  const double sigmas[2] = {options_.level_sigma, options_.level_sigma};
  problem_.AddResidualBlock(new Hold<2>(mean, sigmas), nullptr, tilt_);
  ordering_->AddElementToGroup(tilt_, 1);
  if (!options_.light) problem_.SetParameterBlockConstant(tilt_);
}

void Adjustment::AddViews() {
  const double zero[8] = {0, 0, 0, 0, 0, 0, 0, 0};
  const double residuals = 3.0 * static_cast<double>(texels_.size());
  const double firmness = std::sqrt(std::max(1.0, residuals / options_.evidence));
  const double exposure = options_.exposure_sigma / firmness;
  // One ambient light against the evidence of all views.
  double ambient[3], shift[8];
  std::fill_n(ambient, 3,
              options_.ambient_sigma / firmness / std::sqrt(static_cast<double>(views_.size())));
  std::fill_n(shift, 8, options_.registration_sigma_texel / firmness);
  const auto add = [&](double* block, ceres::CostFunction* hold, bool free) {
    problem_.AddResidualBlock(hold, nullptr, block);
    ordering_->AddElementToGroup(block, 1);
    if (!free) problem_.SetParameterBlockConstant(block);
  };
  for (size_t v = 0; v < views_.size(); ++v) {
    ViewBlocks& view = views_[v];
    if (!problem_.HasParameterBlock(view.light)) continue;  // wholly masked
    Vec3d direction = set_.photographs[v].view.light_in_sample_mm;
    for (double& d : direction) d /= contexts_[v].light_distance_mm;
    problem_.AddResidualBlock(new LightHold(direction, options_.light_sigma / firmness,
                                            options_.distance_sigma / firmness),
                              nullptr, view.light, shared_light_);
    ordering_->AddElementToGroup(view.light, 1);
    if (!options_.light) problem_.SetParameterBlockConstant(view.light);
    add(view.exposure, new Hold<1>(zero, &exposure), options_.exposure);
    add(view.shifts, new Hold<8>(zero, shift), options_.registration);
  }
  add(ambient_, new Hold<3>(zero, ambient), options_.ambient);
  const double shared[3] = {options_.shared_light_sigma, options_.shared_light_sigma,
                            options_.distance_sigma / firmness};
  add(shared_light_, new Hold<3>(zero, shared), options_.light);
  for (int c = 0; c < 3; ++c) {
    // The surroundings give light, they do not take any.
    double least = -1e9;
    for (size_t v = 0; v < views_.size(); ++v) {
      least = std::max(least, -set_.photographs[v].view.ambient_rgb[static_cast<size_t>(c)] /
                                  contexts_[v].irradiance);
    }
    problem_.SetParameterLowerBound(ambient_, c, least);
  }
}

ViewCorrection Adjustment::CorrectionOf(size_t view) const {
  ViewCorrection correction;
  for (size_t i = 0; i < 3; ++i) {
    correction.light_offset_mm[i] = views_[view].light[i] * contexts_[view].light_distance_mm;
    correction.ambient_rgb[i] = ambient_[i] * contexts_[view].irradiance;
  }
  correction.exposure = std::exp(views_[view].exposure[0]);
  std::copy_n(views_[view].shifts, 4, correction.shifts.column);
  std::copy_n(views_[view].shifts + 4, 4, correction.shifts.row);
  return correction;
}

ViewCorrectionResult Adjustment::Solve() {
  ceres::Solver::Options solver;
  solver.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  ordering_ = solver.linear_solver_ordering.get();
  AddTexels();
  ViewCorrectionResult result;
  if (texels_.empty()) {
    result.views.resize(views_.size());
    return result;
  }
  AddViews();
  const int residuals = problem_.NumResiduals();
  problem_.Evaluate({}, &result.cost_before, nullptr, nullptr, nullptr);
  HoldTexels();
  solver.linear_solver_type = ceres::DENSE_SCHUR;
  solver.max_num_iterations = options_.iterations;
  solver.function_tolerance = 1e-4;
  solver.num_threads = 1;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem_, &summary);
  result.cost_after = summary.final_cost;
  result.residual_rms = std::sqrt(2 * result.cost_after / residuals);
  result.iterations = static_cast<int>(summary.iterations.size());
  result.converged = summary.termination_type == ceres::CONVERGENCE;
  for (size_t v = 0; v < views_.size(); ++v) {
    result.views.push_back(summary.IsSolutionUsable() ? CorrectionOf(v) : ViewCorrection{});
  }
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
  if (!(light_sigma > 0)) return "the light's expected offset must be above 0";
  if (!(ambient_sigma > 0)) return "the expected ambient light must be above 0";
  if (!(exposure_sigma > 0)) return "the exposures' expected deviation must be above 0";
  if (!(registration_sigma_texel > 0)) return "the expected displacement must be above 0";
  if (!(residual_sigma > 0)) return "the residuals' deviation must be above 0";
  if (!(robust_scale > 0)) return "the robust scale must be above 0";
  if (texels < 16) return "at least 16 texels are needed";
  if (iterations < 1) return "at least one iteration is needed";
  return "";
}

ViewCorrectionResult CorrectViews(const PhotographSet& set, const SvbrdfMaps& maps,
                                  const ViewCorrectionOptions& options) {
  std::string wrong = options.Check();
  if (wrong.empty()) wrong = set.Check();
  if (!wrong.empty()) throw std::invalid_argument("view correction: " + wrong);
  if (maps.width != set.plane.width || maps.height != set.plane.height) {
    throw std::invalid_argument("view correction: the maps' size is not the photographs'");
  }
  ViewCorrectionResult result = Adjustment(set, maps, options).Solve();
  if (options.registration) CentreShifts(&result.views);
  return result;
}

PhotographSet Corrected(const PhotographSet& set, const std::vector<ViewCorrection>& corrections,
                        int threads) {
  PhotographSet corrected = set;
  ForEachPiece(static_cast<int>(set.photographs.size()), threads, [&](int piece) {
    const size_t i = static_cast<size_t>(piece);
    Photograph& photograph = corrected.photographs[i];
    const ViewCorrection& c = corrections[i];
    for (size_t k = 0; k < 3; ++k) {
      photograph.view.light_in_sample_mm[k] += c.light_offset_mm[k];
      photograph.view.ambient_rgb[k] += c.ambient_rgb[k];
    }
    photograph.view.exposure *= c.exposure;
    if (!c.shifts.any()) return;
    ShiftPicture(c.shifts, set.plane.width, set.plane.height, &photograph.rgb);
    ShiftMask(c.shifts, set.plane.width, set.plane.height, &photograph.mask);
  });
  return corrected;
}

std::vector<ViewCorrection> AtSize(std::vector<ViewCorrection> corrections, int from_width,
                                   int from_height, int to_width, int to_height) {
  for (ViewCorrection& c : corrections) {
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
