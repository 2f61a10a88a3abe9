#include "fitting/view_correction/sampled_texels.h"

#include <ceres/jet.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <span>

#include "base/model/photographs.h"
#include "base/model/solver.h"
#include "base/model/view_correction.h"
#include "base/parallel/parallel.h"
#include "base/reflectance/log_radiance.h"
#include "base/reflectance/texel_at.h"
#include "fitting/texel/texel_parameters.h"
#include "fitting/view_correction/residual_noise.h"

namespace glint {
namespace {

using constants::kCorrectionMargin_texel;

constexpr size_t kTexelsPerPiece = 4 * kBatch;

using Jet = ceres::Jet<double, 3>;  // by the light's offset

// Normals that were fitted under wrong lights are tilted alike and must be free to tilt back.
InitialisationErrors ErrorsOfStart() {
  InitialisationErrors errors;
  errors.normal = constants::kCorrectionNormalSd;
  return errors;
}

// Masked texels may hold anything, and a lookup between texels sees those around it.
bool UsableAround(const std::vector<float>& mask, int width, int column, int row) {
  for (int y = row - kCorrectionMargin_texel; y <= row + kCorrectionMargin_texel; ++y) {
    for (int x = column - kCorrectionMargin_texel; x <= column + kCorrectionMargin_texel; ++x) {
      if (!(mask[static_cast<size_t>(y) * width + x] >= 0.5f)) return false;
    }
  }
  return true;
}

// A texel's radiance with derivatives by the light's offset, in units of `offset_mm`.
void ShadeByLight(const TexelSvbrdf<double>& svbrdf, const View& view,
                  const ReflectanceConvention& convention, double offset_mm, double x_mm,
                  double y_mm, Jet radiance[3]) {
  TexelSvbrdf<Jet> constant;
  Jet light_in_sample_mm[3];
  for (int i = 0; i < 3; ++i) {
    constant.normal[i] = Jet(svbrdf.normal[i]);
    constant.diffuse[i] = Jet(svbrdf.diffuse[i]);
    constant.specular[i] = Jet(svbrdf.specular[i]);
    light_in_sample_mm[i] = Jet(view.light_in_sample_mm[static_cast<size_t>(i)]);
    light_in_sample_mm[i].v[i] = offset_mm;
  }
  constant.roughness = Jet(svbrdf.roughness);
  ShadeRadiance(
      constant,
      TexelGeometryLitFrom(view, convention.falloff, light_in_sample_mm, Jet(x_mm), Jet(y_mm)),
      convention, radiance);
}

// How the residual of batch_kernel.h depends on the radiances that it compares.
struct LogResidual {
  LogResidual(double rendered, double shown, double robust_scale)
      : error(std::log((rendered + kLogOffset) / (shown + kLogOffset))) {
    // Charbonnier's g'
    const double scaled = error / robust_scale;
    const double root = std::sqrt(1 + scaled * scaled);
    const double slope = std::sqrt(0.5 * (1 + root)) / root;
    by_rendered = slope / (rendered + kLogOffset);
    by_shown = -slope / (shown + kLogOffset);
  }
  double error, by_rendered, by_shown;
};

// visit(texels) with the numbers of [begin, end), at most a batch of them at a time.
template <class Visit>
void ForEachBatch(size_t begin, size_t end, const Visit& visit) {
  std::array<size_t, kBatch> texels;
  for (size_t first = begin; first < end; first += kBatch) {
    std::iota(texels.begin(), texels.end(), first);
    visit(std::span<const size_t>(texels).first(std::min<size_t>(kBatch, end - first)));
  }
}

}  // namespace

struct SampledTexels::Texel {
  int column, row;
  double x_mm, y_mm;
  double corner_weights[4];
  TexelValues start;
  std::vector<int> views;  // that see it
  // What it reflects of each term of environment lighting, as the initial maps say (that changes
  // slowly with the normal): its diffuse lobe and, by view that sees it, its specular one.
  std::vector<double> environment;
  std::span<const double> environment_diffuse(int terms) const { return OfEnvironment(0, terms); }
  std::span<const double> environment_specular(size_t k, int terms) const {
    return OfEnvironment(k + 1, terms);
  }

 private:
  std::span<const double> OfEnvironment(size_t k, int terms) const {
    return std::span(environment)
        .subspan(k * static_cast<size_t>(terms), static_cast<size_t>(terms));
  }
};

struct SampledTexels::Worker {
  Worker(const KernelOptions& options, int views)
      : batches(options, constants::kSolveIterations, views, constants::kStarts),
        observations(views),
        residuals(views),
        seen(3 * static_cast<size_t>(views) * kBatch),
        kernel(options) {
    batches.SetNoise(constants::kCorrectionNoise);
  }
  static size_t PlaceOf(int view, int channel, int lane) {
    return (3 * static_cast<size_t>(view) + static_cast<size_t>(channel)) * kBatch +
           static_cast<size_t>(lane);
  }

  BatchSearch batches;
  BatchObservations observations;
  BatchResiduals residuals;
  std::vector<LookedUp> seen;  // by PlaceOf()
  KernelOptions kernel;
};

SampledTexels::~SampledTexels() = default;

int SampledTexels::size() const { return static_cast<int>(texels_.size()); }

SampledTexels::SampledTexels(const PhotographSet& set, const SvbrdfMaps& maps,
                             const ViewUnknowns& unknowns, int texels, double robust_scale,
                             int threads)
    : set_(set), unknowns_(unknowns), threads_(std::max(threads, 1)) {
  const int width = set.plane.width, height = set.plane.height;
  const int stride = std::max(
      1, static_cast<int>(std::lround(std::sqrt(static_cast<double>(maps.texels()) / texels))));
  const EnvironmentLighting environment =
      unknowns.EnvironmentAt(Eigen::VectorXd::Zero(unknowns.size()));
  for (int row = kCorrectionMargin_texel + stride / 2; row < height - kCorrectionMargin_texel;
       row += stride) {
    for (int column = kCorrectionMargin_texel + stride / 2;
         column < width - kCorrectionMargin_texel; column += stride) {
      const size_t index = static_cast<size_t>(row) * width + column;
      Texel texel{column, row, set.plane.x_mm(column), set.plane.y_mm(row), {}, {}, {}, {}};
      for (int v = 0; v < unknowns.views(); ++v) {
        const std::vector<float>& mask = set.photographs[static_cast<size_t>(v)].mask;
        if (UsableAround(mask, width, column, row)) texel.views.push_back(v);
      }
      if (texel.views.empty()) continue;
      texel.start = ReadTexel(maps, index);
      if (environment.any()) AddEnvironment(TexelAt(maps, index), environment, &texel);
      CornerWeights((column + 0.5) / width, (row + 0.5) / height, texel.corner_weights);
      residuals_ += 3.0 * static_cast<double>(texel.views.size());
      texels_.push_back(std::move(texel));
    }
  }
  following_.resize(texels_.size());
  KernelOptions kernel;
  kernel.diffuse_weight = set.convention.diffuse_weight;
  kernel.mix = LobeMixOf<float>(set.convention.lobes);
  kernel.robust_scale = robust_scale;
  for (int i = 0; i < threads_; ++i) {
    workers_.push_back(std::make_unique<Worker>(kernel, unknowns.views()));
  }
}

std::vector<bool> SampledTexels::UsableViews() const {
  std::vector<bool> usable(static_cast<size_t>(unknowns_.views()), false);
  for (const Texel& texel : texels_) {
    for (const int v : texel.views) usable[static_cast<size_t>(v)] = true;
  }
  return usable;
}

SampledTexels::Values SampledTexels::Starts() const {
  Values values;
  for (const Texel& texel : texels_) values.push_back(texel.start);
  return values;
}

TexelPrior SampledTexels::PriorOf(const Texel& texel) const {
  return TexelPrior(TexelGaussian(texel.start, ErrorsOfStart()), residual_sigma_);
}

void SampledTexels::AddEnvironment(const TexelSvbrdf<double>& svbrdf,
                                   const EnvironmentLighting& environment, Texel* texel) const {
  const EnvironmentReflection reflection(svbrdf);
  const auto add = [&](const EnvironmentHarmonics& harmonics) {
    texel->environment.insert(texel->environment.end(), harmonics.begin(),
                              harmonics.begin() + environment.terms());
  };
  add(reflection.diffuse());
  for (const int v : texel->views) {
    const TexelGeometry<double> geometry =
        TexelGeometryInView<double>(set_.photographs[static_cast<size_t>(v)].view,
                                    set_.convention.falloff, texel->x_mm, texel->y_mm);
    add(reflection.Specular(geometry.camera, environment.degree()));
  }
}

SampledTexels::ViewsAt SampledTexels::At(const Eigen::VectorXd& x) const {
  ViewsAt at{x, {}, unknowns_.EnvironmentAt(x)};
  for (int v = 0; v < unknowns_.views(); ++v) at.views.push_back(unknowns_.ViewAt(v, x));
  return at;
}

void SampledTexels::Gather(std::span<const size_t> texels, const ViewsAt& at, Worker* worker,
                           BatchObservations* observations) const {
  const SamplePlane& plane = set_.plane;
  const size_t all = static_cast<size_t>(plane.width) * plane.height;
  const auto& [x, views, environment] = at;
  const bool displaced = unknowns_.kinds().registration;
  observations->Clear(unknowns_.views());
  for (size_t i = 0; i < texels.size(); ++i) {
    const Texel& texel = texels_[texels[i]];
    const int lane = static_cast<int>(i);
    observations->Place(lane, texel.x_mm, texel.y_mm);
    const size_t texel_at = static_cast<size_t>(texel.row) * plane.width + texel.column;
    for (const int v : texel.views) {
      const Photograph& photograph = set_.photographs[static_cast<size_t>(v)];
      double column = texel.column, row = texel.row;
      for (int k = 0; displaced && k < 4; ++k) {
        column += texel.corner_weights[k] * x[unknowns_.shift(v) + k];
        row += texel.corner_weights[k] * x[unknowns_.shift(v) + 4 + k];
      }
      std::optional<PictureLookUp> place;
      if (displaced) place.emplace(plane.width, plane.height, column, row);
      float radiance[3];
      bool clipped[3];
      for (int c = 0; c < 3; ++c) {
        const float* picture = photograph.rgb.data() + static_cast<size_t>(c) * all;
        LookedUp seen = place ? place->In(picture) : LookedUp{picture[texel_at], 0, 0};
        seen.value = std::max(seen.value, 0.0);
        radiance[c] = static_cast<float>(seen.value);
        clipped[c] = photograph.ldr && seen.value >= constants::kClippedRadiance;
        worker->seen[Worker::PlaceOf(v, c, lane)] = seen;
      }
      observations->Set(lane, v, radiance, clipped);
    }
  }
  for (int v = 0; v < unknowns_.views(); ++v) {
    observations->Complete(v, BatchView(views[static_cast<size_t>(v)], set_.convention.falloff));
  }
  if (!environment.any()) return;
  for (size_t i = 0; i < texels.size(); ++i) {
    const Texel& texel = texels_[texels[i]];
    const Vec3d diffuse =
        EnvironmentIrradiance(environment, texel.environment_diffuse(environment.terms()));
    for (size_t k = 0; k < texel.views.size(); ++k) {
      const View& view = views[static_cast<size_t>(texel.views[k])];
      const Vec3d specular =
          EnvironmentIrradiance(environment, texel.environment_specular(k, environment.terms()));
      double ambient[3], ambient_specular[3];
      for (size_t c = 0; c < 3; ++c) {
        ambient[c] = view.exposure * (view.ambient_rgb[c] + diffuse[c]);
        ambient_specular[c] = view.exposure * (view.ambient_rgb[c] + specular[c]);
      }
      observations->SetAmbient(static_cast<int>(i), texel.views[k], ambient, ambient_specular);
    }
  }
}

// The sum of the texels' costs.
double SampledTexels::FitBlock(size_t first, size_t count, const ViewsAt& at, const Values* others,
                               Worker* worker, Values* values) const {
  const Values starts(values->begin() + static_cast<std::ptrdiff_t>(first),
                      values->begin() + static_cast<std::ptrdiff_t>(first + count));
  std::vector<double> costs(count, std::numeric_limits<double>::infinity());
  const auto fit = [&](const TexelValues* from) {
    worker->batches.Begin(
        BatchSearch::From::kStart,
        [&](std::span<const size_t> texels, BatchObservations* observations) {
          Gather(texels, at, worker, observations);
          return observations;
        },
        [&](const BatchSearch::Task& task, const BatchSearch::Found& found) {
          double& cost = costs[task.id - first];
          if (!(found.solution.cost < cost)) return;
          cost = found.solution.cost;
          (*values)[task.id] = found.solution.values;
        });
    for (size_t i = 0; i < count; ++i) {
      worker->batches.Add(
          {.id = first + i, .prior = PriorOf(texels_[first + i]), .start = from[i]});
    }
    worker->batches.Finish();
  };
  fit(starts.data());
  if (others != nullptr) fit(others->data() + first);
  double sum = 0;
  for (const double cost : costs) sum += cost;
  return sum;
}

double SampledTexels::Fit(const Eigen::VectorXd& x, const Values* others, Values* values) {
  const size_t pieces = (texels_.size() + kTexelsPerPiece - 1) / kTexelsPerPiece;
  std::vector<double> costs(pieces);
  const ViewsAt views = At(x);
  ForEachPieceByWorker(static_cast<int>(pieces), threads_, [&](int piece, int at) {
    const size_t k = static_cast<size_t>(piece), first = k * kTexelsPerPiece;
    costs[k] = FitBlock(first, std::min(kTexelsPerPiece, texels_.size() - first), views, others,
                        workers_[static_cast<size_t>(at)].get(), values);
  });
  double sum = 0;
  for (const double cost : costs) sum += cost;
  return sum;
}

BatchGram SampledTexels::GramAt(std::span<const size_t> texels, const ViewsAt& at,
                                const Values& values, Worker* worker) const {
  Gather(texels, at, worker, &worker->observations);
  BatchValues batch;
  for (size_t i = 0; i < texels.size(); ++i) {
    SetLane(static_cast<int>(i), values[texels[i]], &batch);
  }
  BatchGram gram;
  worker->batches.evaluator().Gram(worker->observations, batch, &gram, &worker->residuals);
  return gram;
}

void SampledTexels::AddResiduals(const Texel& texel, int lane, const ViewsAt& at,
                                 const TexelValues& values, const Worker& worker,
                                 TexelReduction* reduction) const {
  const TexelSvbrdf<double> svbrdf = TexelFromValues(values.data());
  const UnknownKinds& kinds = unknowns_.kinds();
  const EnvironmentLighting& environment = at.environment;
  Eigen::VectorXd by_environment(environment.terms());
  std::vector<std::pair<int, double>> by_views;
  for (size_t k = 0; k < texel.views.size(); ++k) {
    const int v = texel.views[k];
    const View& view = at.views[static_cast<size_t>(v)];
    Jet radiance[3];
    ShadeByLight(svbrdf, view, set_.convention, unknowns_.light_distance_mm(v), texel.x_mm,
                 texel.y_mm, radiance);
    const bool ldr = set_.photographs[static_cast<size_t>(v)].ldr;
    for (int c = 0; c < 3; ++c) {
      const LookedUp& seen = worker.seen[Worker::PlaceOf(v, c, lane)];
      radiance[c].a +=
          ReflectEnvironment(texel, k, svbrdf, view.exposure, environment, c, &by_environment);
      const LogResidual residual(radiance[c].a, seen.value, worker.kernel.robust_scale);
      const bool clipped = ldr && seen.value >= constants::kClippedRadiance;
      if (clipped && residual.error > 0) continue;  // satisfied
      by_views.clear();
      for (int i = 0; kinds.light && i < 3; ++i) {
        by_views.emplace_back(unknowns_.light(v) + i, residual.by_rendered * radiance[c].v[i]);
      }
      if (kinds.exposure) {
        by_views.emplace_back(unknowns_.exposure(v), residual.by_rendered * radiance[c].a);
      }
      for (int i = 0; kinds.registration && i < 4; ++i) {
        const double weight = residual.by_shown * texel.corner_weights[i];
        by_views.emplace_back(unknowns_.shift(v) + i, weight * seen.by_column);
        by_views.emplace_back(unknowns_.shift(v) + 4 + i, weight * seen.by_row);
      }
      reduction->Add(worker.residuals, v, c, lane, by_views,
                     residual.by_rendered * unknowns_.environment_unit() *
                         by_environment.head(kinds.environment_terms));
    }
  }
}

double SampledTexels::ReflectEnvironment(const Texel& texel, size_t k,
                                         const TexelSvbrdf<double>& svbrdf, double exposure,
                                         const EnvironmentLighting& environment, int channel,
                                         Eigen::VectorXd* by_term) const {
  const double diffuse =
      exposure * DiffuseLobe(svbrdf, set_.convention.diffuse_weight, channel).value;
  const double specular = exposure * svbrdf.specular[channel] * kInversePi;
  const std::span<const double> of_diffuse = texel.environment_diffuse(environment.terms());
  const std::span<const double> of_specular = texel.environment_specular(k, environment.terms());
  double radiance = 0;
  for (size_t j = 0; j < environment.radiance_rgb.size(); ++j) {
    const double by = diffuse * of_diffuse[j] + specular * of_specular[j];
    (*by_term)[static_cast<Eigen::Index>(j)] = by;
    radiance += by * environment.radiance_rgb[j][static_cast<size_t>(channel)];
  }
  return radiance;
}

NormalEquations SampledTexels::Reduce(const Eigen::VectorXd& x, const Values& values) {
  const ViewsAt views = At(x);
  while (reductions_.size() < constants::kCorrectionSums) {
    reductions_.emplace_back(unknowns_.size(), unknowns_.kinds().environment_terms);
  }
  ForEachPieceByWorker(constants::kCorrectionSums, threads_, [&](int piece, int at) {
    const size_t k = static_cast<size_t>(piece);
    const size_t begin = texels_.size() * k / constants::kCorrectionSums;
    const size_t end = texels_.size() * (k + 1) / constants::kCorrectionSums;
    Worker* worker = workers_[static_cast<size_t>(at)].get();
    TexelReduction& reduction = reductions_[k];
    reduction.Clear();
    ForEachBatch(begin, end, [&](std::span<const size_t> texels) {
      GramAt(texels, views, values, worker);
      for (size_t i = 0; i < texels.size(); ++i) {
        const size_t t = texels[i];
        TexelGram gram =
            worker->residuals.GramOf(static_cast<int>(i), worker->observations.views());
        PriorOf(texels_[t]).AddTo(values[t], &gram);
        reduction.Begin(values[t]);
        AddResiduals(texels_[t], static_cast<int>(i), views, values[t], *worker, &reduction);
        reduction.Eliminate(gram, &following_[t]);
      }
    });
    reduction.Finish();
  });
  NormalEquations total(unknowns_.size());
  for (const TexelReduction& reduction : reductions_) {
    total.hessian += reduction.equations.hessian;
    total.gradient += reduction.equations.gradient;
  }
  // Only the lower triangle is complete.
  total.hessian.triangularView<Eigen::StrictlyUpper>() = total.hessian.transpose();
  return total;
}

SampledTexels::Values SampledTexels::Follow(const Eigen::VectorXd& step,
                                            const Values& values) const {
  Values followed = values;
  for (size_t k = 0; k < texels_.size(); ++k) {
    const TexelFollowing::Vector by = following_[k].After(step);
    const double length = by.tail<kTexelParameters - kRough>().norm();
    const double share =
        length > constants::kMostTexelStep ? constants::kMostTexelStep / length : 1;
    double variables[kTexelParameters];
    ToVariables(values[k], variables);
    for (int i = 0; i < kTexelParameters; ++i) variables[i] -= share * by[i];
    TexelValues derivatives;
    ToTexelValues(variables, &followed[k], &derivatives);
  }
  return followed;
}

Eigen::Vector2d SampledTexels::MeanSlope(const Values& values) const {
  Eigen::Vector2d mean(0, 0);
  for (const TexelValues& v : values) mean += Eigen::Vector2d(v[kSlopeX], v[kSlopeY]);
  return mean / std::max<double>(1, static_cast<double>(values.size()));
}

Eigen::MatrixXd SampledTexels::MeanSlopeByViews() const {
  Eigen::MatrixXd by = Eigen::MatrixXd::Zero(2, unknowns_.size());
  for (const TexelFollowing& following : following_) {
    for (int i = 0; i < 2; ++i) by.row(i) -= following.ByViewsOf(kSlopeX + i);
  }
  return by / std::max(1, size());
}

SystematicDeviations SampledTexels::PropagatedDeviations(const Eigen::MatrixXd& hessian,
                                                         const Values& values) const {
  const Eigen::LDLT<Eigen::MatrixXd> factor(hessian);
  const size_t count = std::min(constants::kPropagatedTexels, texels_.size());
  TexelValues variances{}, squares{};
  Eigen::MatrixXd by_views(unknowns_.size(), kTexelParameters);
  for (size_t i = 0; i < count; ++i) {
    const size_t k = i * texels_.size() / count;
    double variables[kTexelParameters];
    TexelValues value, derivatives;
    ToVariables(values[k], variables);
    ToTexelValues(variables, &value, &derivatives);
    for (int p = 0; p < kTexelParameters; ++p) {
      by_views.col(p) =
          derivatives[static_cast<size_t>(p)] * following_[k].ByViewsOf(p).transpose();
    }
    const Eigen::MatrixXd covariance_by_views = factor.solve(by_views);
    for (int p = 0; p < kTexelParameters; ++p) {
      variances[static_cast<size_t>(p)] += by_views.col(p).dot(covariance_by_views.col(p));
      squares[static_cast<size_t>(p)] +=
          value[static_cast<size_t>(p)] * value[static_cast<size_t>(p)];
    }
  }
  const auto of_channels = [](const TexelValues& values_of, int (*parameter)(int)) {
    double sum = 0;
    for (int c = 0; c < 3; ++c) sum += values_of[static_cast<size_t>(parameter(c))];
    return sum;
  };
  const auto relative = [&](int (*parameter)(int)) {
    const double all = of_channels(squares, parameter);
    return all > 0 ? std::sqrt(of_channels(variances, parameter) / all) : 0;
  };
  const double texels = static_cast<double>(count);
  return {.diffuse = relative(DiffuseParameter),
          .specular = relative(SpecularParameter),
          .roughness = std::sqrt(variances[kRough] / texels),
          .slope = std::sqrt((variances[kSlopeX] + variances[kSlopeY]) / (2 * texels))};
}

double SampledTexels::SharedNoise(const Eigen::VectorXd& x, const Values& values) {
  Worker* worker = workers_.front().get();
  ResidualNoise noise;
  const ViewsAt views = At(x);
  ForEachBatch(0, texels_.size(), [&](std::span<const size_t> texels) {
    const BatchGram photographs = GramAt(texels, views, values, worker);
    for (size_t i = 0; i < texels.size(); ++i) {
      const int lane = static_cast<int>(i);
      const int freedom = 3 * worker->observations.seen(lane) - kTexelParameters;
      if (freedom < constants::kLeastFreedom) continue;
      const double squares =
          photographs.Squares(lane) + PriorOf(texels_[texels[i]]).SquaredNorm(values[texels[i]]);
      noise.Add(worker->observations, worker->residuals, lane, squares / freedom);
    }
  });
  return noise.Shared();
}

}  // namespace glint
