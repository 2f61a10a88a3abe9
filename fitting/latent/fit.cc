#include "fitting/latent/fit.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>

#include "fitting/latent/descent.h"
#include "fitting/latent/fit_loss.h"
#include "fitting/latent/levels.h"

namespace glint {
namespace {

constexpr double kMostLightScale = 16;  // and 1/16 the least
constexpr double kLightRate = 0.02;     // Adam's, on the scale's logarithm
constexpr double kLightPrior = 1e-3;    // pull of its square: albedo and power trade off otherwise
constexpr float kMostCode = 0.995f;     // of |t| where tanh is inverted: its gradient must not vanish

// What a level optimises: parameters ↔ encoded maps, and the gradient back.
class Parameters {
 public:
  virtual ~Parameters() = default;
  virtual std::vector<float> FromMaps(const EncodedMaps& maps) = 0;
  virtual EncodedMaps ToMaps(std::span<const float> values) = 0;
  // Gradient by the parameters of the last ToMaps.
  virtual std::vector<float> Pull(const EncodedMaps& gradient) = 0;
  // The descent begins at `values`, which stand for the maps `start`.
  virtual void SetStart(const EncodedMaps&, std::span<const float>) {}
  // A regulariser's value; adds its gradient.
  virtual double Prior(std::span<const float>, std::span<float>) const { return 0; }
  // The maps of a result: as exact as can be.
  virtual EncodedMaps Final(std::span<const float> values) { return ToMaps(values); }
};

// The maps themselves, t = tanh(u).
class MapParameters : public Parameters {
 public:
  MapParameters(int width, int height) : maps_(width, height) {}

  std::vector<float> FromMaps(const EncodedMaps& maps) override {
    std::vector<float> u(maps.planes.size());
    for (size_t i = 0; i < u.size(); ++i) {
      u[i] = std::atanh(std::clamp(maps.planes[i], -kMostCode, kMostCode));
    }
    return u;
  }
  EncodedMaps ToMaps(std::span<const float> values) override {
    for (size_t i = 0; i < values.size(); ++i) maps_.planes[i] = std::tanh(values[i]);
    return maps_;
  }
  std::vector<float> Pull(const EncodedMaps& gradient) override {
    std::vector<float> g(gradient.planes.size());
    for (size_t i = 0; i < g.size(); ++i) {
      g[i] = gradient.planes[i] * (1 - maps_.planes[i] * maps_.planes[i]);
    }
    return g;
  }

 private:
  EncodedMaps maps_;
};

// The latent code.
class CodeParameters : public Parameters {
 public:
  CodeParameters(const Autoencoder& network, int width, int height, const FitOptions& options)
      : network_(network),
        tape_(network, options.fast, options.threads),
        width_(width),
        height_(height),
        options_(options) {}

  std::vector<float> FromMaps(const EncodedMaps& maps) override {
    code_ = network_.Encode(DecodeMaps(maps), options_.threads);
    return code_.values;
  }
  EncodedMaps ToMaps(std::span<const float> values) override {
    code_.values.assign(values.begin(), values.end());
    return WithDetail(tape_.Forward(code_, width_, height_));
  }
  void SetStart(const EncodedMaps& start, std::span<const float> values) override {
    start_.assign(values.begin(), values.end());
    if (!options_.keep_detail) return;
    const EncodedMaps decoded = Final(values);
    detail_ = start.planes;
    for (size_t i = 0; i < detail_.size(); ++i) detail_[i] -= decoded.planes[i];
  }
  std::vector<float> Pull(const EncodedMaps& gradient) override { return tape_.Backward(gradient); }
  double Prior(std::span<const float> values, std::span<float> gradient) const override {
    const double count = static_cast<double>(values.size());
    double sum = 0, start_sum = 0;
    for (size_t i = 0; i < values.size(); ++i) {
      const double z = values[i], moved = z - start_[i];
      sum += z * z;
      start_sum += moved * moved;
      gradient[i] += static_cast<float>(
          2 / count * (options_.code_prior * z + options_.start_prior * moved));
    }
    return (options_.code_prior * sum + options_.start_prior * start_sum) / count;
  }
  EncodedMaps Final(std::span<const float> values) override {
    code_.values.assign(values.begin(), values.end());
    return WithDetail(network_.Decode(code_, width_, height_, options_.threads));
  }
  const LatentCode& code() const { return code_; }

 private:
  EncodedMaps WithDetail(EncodedMaps maps) const {
    for (size_t i = 0; i < detail_.size(); ++i) {
      maps.planes[i] = std::clamp(maps.planes[i] + detail_[i], -1.0f, 1.0f);
    }
    return maps;
  }

  const Autoencoder& network_;
  Autoencoder::Tape tape_;
  int width_, height_;
  FitOptions options_;
  LatentCode code_;
  std::vector<float> start_;
  std::vector<float> detail_;  // of the start, beyond what its code decodes to; empty: none
};

// The common factor on the lights, by its logarithm, when the photographs leave it open.
class LightScale {
 public:
  LightScale(bool known, double rate) : known_(known), rate_(rate) {}
  double value() const { return std::exp(log_); }
  void Step(double gradient) {
    if (known_) return;
    // Adam on one number.
    const double g = gradient + 2 * kLightPrior * log_;
    moment1_ = 0.5 * moment1_ + 0.5 * g;
    moment2_ = 0.99 * moment2_ + 0.01 * g * g;
    power1_ *= 0.5;
    power2_ *= 0.99;
    log_ -= rate_ * (moment1_ / (1 - power1_)) / (std::sqrt(moment2_ / (1 - power2_)) + 1e-8);
    log_ = std::clamp(log_, -std::log(kMostLightScale), std::log(kMostLightScale));
  }
  void Slow(double factor) { rate_ *= factor; }

 private:
  bool known_;
  double rate_;
  double log_ = 0, moment1_ = 0, moment2_ = 0, power1_ = 1, power2_ = 1;
};

// Brings D(z) near the start: z = E(start) decodes to it only as well as the network was trained.
std::vector<float> PullOntoStart(Parameters* parameters, std::vector<float> values,
                                 const EncodedMaps& start, const FitOptions& options) {
  Descent descent({options.start_iterations, options.learning_rate, 0.0, options.start_iterations},
                  values.size());
  const float scale = 1.0f / static_cast<float>(start.planes.size());
  EncodedMaps gradient(start.width, start.height);
  while (descent.Going()) {
    const EncodedMaps maps = parameters->ToMaps(values);
    double loss = 0;
    for (size_t i = 0; i < maps.planes.size(); ++i) {
      const float difference = maps.planes[i] - start.planes[i];
      loss += std::abs(difference);
      gradient.planes[i] = difference > 0 ? scale : difference < 0 ? -scale : 0;
    }
    descent.Step(loss * scale, parameters->Pull(gradient), values);
  }
  return descent.losses().empty() ? values : descent.best();
}

struct Run {
  const PhotographSet* set;
  const FitOptions* options;
  const FitProgress* progress;
  int done = 0, total = 0;
};

EncodedMaps FitOneLevel(const PhotographSet& level_set, Parameters* parameters,
                        const EncodedMaps& start, bool pull, int iterations, LightScale* light,
                        Run* run, FitLevel* level) {
  const FitOptions& options = *run->options;
  const FitLoss loss(level_set, options.threads);
  std::vector<float> values = parameters->FromMaps(start);
  if (pull) values = PullOntoStart(parameters, std::move(values), start, options);
  parameters->SetStart(start, values);
  Descent descent({iterations, options.learning_rate, options.tolerance, options.patience},
                  values.size());
  double rate = descent.rate();
  while (descent.Going()) {
    const FitLossValue value = loss.Evaluate(parameters->ToMaps(values), light->value(), true);
    std::vector<float> gradient = parameters->Pull(value.gradient);
    const double prior = parameters->Prior(values, gradient);
    level->loss.push_back(value.loss);
    descent.Step(value.loss + prior, gradient, values);
    light->Slow(descent.rate() / rate);
    rate = descent.rate();
    light->Step(value.log_light_scale_gradient);
    if (*run->progress) (*run->progress)(++run->done, run->total, value.loss);
  }
  level->converged = descent.converged();
  return parameters->Final(descent.losses().empty() ? values : descent.best());
}

using MakeParameters = std::function<std::unique_ptr<Parameters>(int width, int height)>;

FitResult Fit(const PhotographSet& set, const SvbrdfMaps& start, const FitOptions& options,
              bool pull, const MakeParameters& make, const FitProgress& progress) {
  for (const std::string& wrong : {set.Check(), options.Check()}) {
    if (!wrong.empty()) throw std::invalid_argument("fit: " + wrong);
  }
  const auto sizes = LevelSizes(set.plane.width, set.plane.height, options.coarse_size);
  Run run{&set, &options, &progress, 0, options.coarse_iterations +
          static_cast<int>(sizes.size() - 1) * options.fine_iterations};
  LightScale light(set.light_power_known, kLightRate);
  FitResult result;
  EncodedMaps maps = EncodeMaps(start);
  for (size_t k = 0; k < sizes.size(); ++k) {
    const auto [width, height] = sizes[k];
    const bool full = k + 1 == sizes.size();
    const PhotographSet small = full ? PhotographSet{}
                                     : Downsampled(set, width, height, options.threads);
    const PhotographSet& level_set = full ? set : small;
    maps = Resized(maps, width, height);
    if (k == 0) {
      result.start_loss = FitLoss(level_set, options.threads).Evaluate(maps, 1, false).loss;
    }
    const std::unique_ptr<Parameters> parameters = make(width, height);
    FitLevel level{width, height, {}, false};
    maps = FitOneLevel(level_set, parameters.get(), maps, pull,
                       k == 0 ? options.coarse_iterations : options.fine_iterations, &light, &run,
                       &level);
    if (const auto* code = dynamic_cast<const CodeParameters*>(parameters.get())) {
      result.code = code->code();
    }
    result.levels.push_back(std::move(level));
  }
  const FitLossValue last = FitLoss(set, options.threads).Evaluate(maps, light.value(), false);
  result.final_loss = last.loss;
  result.view_loss = last.view_loss;
  result.light_scale = light.value();
  result.maps = DecodeMaps(maps);
  return result;
}

}  // namespace

FitOptions FitOptions::Classic() {
  FitOptions options;
  options.coarse_iterations = 800;
  options.fine_iterations = 200;
  return options;
}

std::string FitOptions::Check() const {
  if (coarse_iterations < 0 || fine_iterations < 0 || start_iterations < 0) {
    return "iterations must be 0 or more";
  }
  if (coarse_size < 1) return "the coarse size must be at least 1 texel";
  if (!(learning_rate > 0)) return "the learning rate must be above 0";
  if (!(tolerance >= 0) || patience < 1) return "tolerance must be 0 or more, patience 1 or more";
  if (!(code_prior >= 0) || !(start_prior >= 0)) return "priors must be 0 or more";
  return "";
}

std::string FitResult::BriefReport() const {
  char text[200];
  int iterations = 0;
  for (const FitLevel& level : levels) iterations += static_cast<int>(level.loss.size());
  std::snprintf(text, sizeof text, "%dx%d texels, %zu levels, %d iterations, loss %.4f -> %.4f",
                maps.width, maps.height, levels.size(), iterations, start_loss, final_loss);
  std::string report = text;
  if (light_scale != 1) {
    std::snprintf(text, sizeof text, ", light x %.3f", light_scale);
    report += text;
  }
  return report;
}

FitResult FitLatent(const PhotographSet& set, const SvbrdfMaps& start, const Autoencoder& network,
                    const FitOptions& options, const FitProgress& progress) {
  FitOptions weighed = options;
  weighed.start_prior /= std::max<double>(1, static_cast<double>(set.photographs.size()));
  return Fit(set, start, options, options.start_iterations > 0,
             [&](int width, int height) {
               return std::make_unique<CodeParameters>(network, width, height, weighed);
             },
             progress);
}

FitResult FitClassic(const PhotographSet& set, const SvbrdfMaps& start, const FitOptions& options,
                     const FitProgress& progress) {
  return Fit(set, start, options, false,
             [](int width, int height) { return std::make_unique<MapParameters>(width, height); },
             progress);
}

}  // namespace glint
