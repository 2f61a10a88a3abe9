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
constexpr float kMostCode = 0.995f;  // of |t| where tanh is inverted: its gradient must not vanish

// What a level optimises: parameters ↔ encoded maps, and the gradient back.
class Parameters {
 public:
  virtual ~Parameters() = default;
  virtual std::vector<float> FromMaps(const EncodedMaps& maps) = 0;
  virtual EncodedMaps ToMaps(std::span<const float> values) = 0;
  // Gradient by the parameters of the last ToMaps.
  virtual std::vector<float> Pull(const EncodedMaps& gradient) = 0;
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
    return tape_.Forward(code_, width_, height_);
  }
  std::vector<float> Pull(const EncodedMaps& gradient) override { return tape_.Backward(gradient); }
  double Prior(std::span<const float> values, std::span<float> gradient) const override {
    if (options_.code_prior <= 0) return 0;
    double sum = 0;
    const double scale = options_.code_prior / static_cast<double>(values.size());
    for (size_t i = 0; i < values.size(); ++i) {
      sum += static_cast<double>(values[i]) * values[i];
      gradient[i] += static_cast<float>(2 * scale * values[i]);
    }
    return scale * sum;
  }
  EncodedMaps Final(std::span<const float> values) override {
    code_.values.assign(values.begin(), values.end());
    return network_.Decode(code_, width_, height_, options_.threads);
  }
  const LatentCode& code() const { return code_; }

 private:
  const Autoencoder& network_;
  Autoencoder::Tape tape_;
  int width_, height_;
  FitOptions options_;
  LatentCode code_;
};

// The latent code and the decoder's weights: values are the code's, then the weights' distance from
// the trained ones in units of `tune_rate`.
class TunedParameters : public Parameters {
 public:
  TunedParameters(const Autoencoder& network, const LatentCode& code, int width, int height,
                  const FitOptions& options)
      : network_(network),
        tape_(network, options.fast, options.threads),
        width_(width),
        height_(height),
        options_(options),
        code_(code),
        trained_(network.DecoderWeights()) {}

  std::vector<float> FromMaps(const EncodedMaps&) override {
    std::vector<float> values = code_.values;
    values.resize(values.size() + trained_.size(), 0.0f);
    return values;
  }
  EncodedMaps ToMaps(std::span<const float> values) override {
    Take(values);
    return tape_.ForwardTuned(code_, weights_, width_, height_);
  }
  std::vector<float> Pull(const EncodedMaps& gradient) override {
    std::vector<float> g = tape_.BackwardTuned(gradient);
    for (size_t i = code_.values.size(); i < g.size(); ++i) {
      g[i] *= static_cast<float>(options_.tune_rate);
    }
    return g;
  }
  EncodedMaps Final(std::span<const float> values) override {
    Take(values);
    return network_.WithDecoder(weights_).Decode(code_, width_, height_, options_.threads);
  }

 private:
  void Take(std::span<const float> values) {
    const size_t codes = code_.values.size();
    code_.values.assign(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(codes));
    weights_.resize(trained_.size());
    for (size_t i = 0; i < weights_.size(); ++i) {
      weights_[i] = trained_[i] + static_cast<float>(options_.tune_rate) * values[codes + i];
    }
  }
  const Autoencoder& network_;
  Autoencoder::Tape tape_;
  int width_, height_;
  FitOptions options_;
  LatentCode code_;
  std::vector<float> trained_, weights_;
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
              bool pull, const Autoencoder* network, const MakeParameters& make,
              const FitProgress& progress) {
  for (const std::string& wrong : {set.Check(), options.Check()}) {
    if (!wrong.empty()) throw std::invalid_argument("fit: " + wrong);
  }
  const auto sizes =
      LevelSizes(set.plane.width, set.plane.height, options.coarse_size, options.finest_size);
  Run run{&set, &options, &progress, 0,
          options.coarse_iterations + static_cast<int>(sizes.size() - 1) * options.fine_iterations +
              (network == nullptr ? 0 : options.tune_iterations)};
  LightScale light(set.light_power_known, kLightRate);
  FitResult result;
  EncodedMaps maps = EncodeMaps(start);
  for (size_t k = 0; k < sizes.size(); ++k) {
    const auto [width, height] = sizes[k];
    const bool last_level = k + 1 == sizes.size();
    const bool full = width == set.plane.width && height == set.plane.height;
    const PhotographSet small =
        full ? PhotographSet{} : Downsampled(set, width, height, options.threads);
    const PhotographSet& level_set = full ? set : small;
    maps = Resized(maps, width, height);
    if (k == 0) {
      result.start_loss = FitLoss(level_set, options.threads).Evaluate(maps, 1, false).loss;
    }
    const std::unique_ptr<Parameters> parameters = make(width, height);
    FitLevel level{width, height, false, {}, false};
    maps = FitOneLevel(level_set, parameters.get(), maps, pull,
                       k == 0 ? options.coarse_iterations : options.fine_iterations, &light, &run,
                       &level);
    if (const auto* code = dynamic_cast<const CodeParameters*>(parameters.get())) {
      result.code = code->code();
      result.levels.push_back(std::move(level));
      if (last_level && options.tune_iterations > 0) {
        TunedParameters tuned(*network, code->code(), width, height, options);
        FitLevel last{width, height, true, {}, false};
        maps = FitOneLevel(level_set, &tuned, maps, false, options.tune_iterations, &light, &run,
                           &last);
        result.levels.push_back(std::move(last));
      }
    } else {
      result.levels.push_back(std::move(level));
    }
  }
  maps = Resized(maps, set.plane.width, set.plane.height);
  const FitLossValue last = FitLoss(set, options.threads).Evaluate(maps, light.value(), false);
  result.final_loss = last.loss;
  result.view_loss = last.view_loss;
  result.light_scale = light.value();
  result.maps = DecodeMaps(maps);
  return result;
}

}  // namespace

FitOptions FitOptions::LatentForRefinement() {
  FitOptions options;
  options.coarse_iterations = 100;
  options.fine_iterations = 30;
  return options;
}

FitOptions FitOptions::Classic() {
  FitOptions options;
  options.coarse_iterations = 3000;  // it ends by its tolerance, after 300 to 1500
  options.fine_iterations = 200;
  return options;
}

std::string FitOptions::Check() const {
  if (coarse_iterations < 0 || fine_iterations < 0 || start_iterations < 0 || tune_iterations < 0) {
    return "iterations must be 0 or more";
  }
  if (coarse_size < 1) return "the coarse size must be at least 1 texel";
  if (finest_size < coarse_size) return "the finest size must be the coarse size or more";
  if (!(tune_rate > 0)) return "the tuning rate must be above 0";
  if (!(learning_rate > 0)) return "the learning rate must be above 0";
  if (!(tolerance >= 0) || patience < 1) return "tolerance must be 0 or more, patience 1 or more";
  if (!(code_prior >= 0)) return "the code's prior must be 0 or more";
  return "";
}

double FitResult::fitted_loss() const {
  if (levels.empty() || levels.back().loss.empty()) return final_loss;
  return *std::min_element(levels.back().loss.begin(), levels.back().loss.end());
}

std::string FitResult::BriefReport() const {
  char text[200];
  int iterations = 0;
  for (const FitLevel& level : levels) iterations += static_cast<int>(level.loss.size());
  std::snprintf(text, sizeof text, "%dx%d texels, %zu levels, %d iterations, loss %.4f -> %.4f",
                maps.width, maps.height, levels.size(), iterations, start_loss, fitted_loss());
  std::string report = text;
  if (light_scale != 1) {
    std::snprintf(text, sizeof text, ", light x %.3f", light_scale);
    report += text;
  }
  return report;
}

FitResult FitLatent(const PhotographSet& set, const SvbrdfMaps& start, const Autoencoder& network,
                    const FitOptions& options, const FitProgress& progress) {
  return Fit(
      set, start, options, options.start_iterations > 0, &network,
      [&](int width, int height) {
        return std::make_unique<CodeParameters>(network, width, height, options);
      },
      progress);
}

FitResult FitClassic(const PhotographSet& set, const SvbrdfMaps& start, const FitOptions& options,
                     const FitProgress& progress) {
  return Fit(
      set, start, options, false, nullptr,
      [](int width, int height) { return std::make_unique<MapParameters>(width, height); },
      progress);
}

FitResult KeepStart(const PhotographSet& set, const SvbrdfMaps& start, int threads) {
  if (const std::string wrong = set.Check(); !wrong.empty()) {
    throw std::invalid_argument("fit: " + wrong);
  }
  const bool fits = start.width == set.plane.width && start.height == set.plane.height;
  const EncodedMaps encoded = Resized(EncodeMaps(start), set.plane.width, set.plane.height);
  const FitLossValue loss = FitLoss(set, threads).Evaluate(encoded, 1, false);
  FitResult result;
  result.maps = fits ? start : DecodeMaps(encoded);
  result.start_loss = result.final_loss = loss.loss;
  result.view_loss = loss.view_loss;
  return result;
}

}  // namespace glint
