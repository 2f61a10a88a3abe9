#include "fitting/autoencoder/trainer.h"


#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <stdexcept>

#include "fitting/autoencoder/adam.h"
#include "fitting/autoencoder/encoding.h"
#include "fitting/autoencoder/encoding_torch.h"
#include "fitting/autoencoder/principal_start.h"
#include "fitting/autoencoder/random.h"
#include "fitting/autoencoder/render_loss.h"
#include "fitting/autoencoder/train_state.h"
#include "fitting/render/render_autograd.h"

namespace glint {
namespace {

using torch::Tensor;

constexpr int kValidationMaterials = 16;
constexpr double kBatchStatisticsMomentum = 0.005;
constexpr double kReportSeconds = 5.0;
constexpr std::uint64_t kNoiseStream = 0x5EED0001;
constexpr std::uint64_t kViewStream = 0x5EED0002;

double Now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void Check(const TrainOptions& o) {
  const auto require = [](bool good, const std::string& message) {
    if (!good) throw std::runtime_error("training options: " + message);
  };
  require(o.steps > 0 || o.minutes > 0, "found neither steps nor minutes; give one of them");
  require(o.batch >= 1 && o.batch <= 4096, "found batch " + std::to_string(o.batch) +
                                               "; it must be 1 to 4096");
  require(o.crop >= 32 && o.crop % kDownsampling == 0 && o.crop <= o.pool.material_size,
          "found crop " + std::to_string(o.crop) +
              "; it must be a multiple of 32 that fits the materials");
  require(o.smoothness >= 0 && o.render_weight >= 0 && o.noise_variance >= 0,
          "found a negative weight or variance; they must be 0 or more");
  require(o.threads >= 1, "found threads below 1");
}

struct Losses {
  Tensor total;
  double map = 0, smoothness = 0, render = 0;
};

Tensor MapWeights(const TrainOptions& o) {
  Tensor w = torch::ones({1, kEncodedChannels, 1, 1});
  w.slice(1, kEncodedNormal, kEncodedChannels).fill_(o.normal_weight);
  return w / w.mean();
}

// One training run: what the loop in Train() repeats.
class Trainer {
 public:
  Trainer(const TrainOptions& options, TrainState state)
      : options_(options),
        compute_(options.bf16 ? FastComputeType() : torch::kFloat32),
        map_weights_(MapWeights(options)),
        state_(std::move(state)) {}

  TrainState* state() { return &state_; }

  // Fraction of the training that is over.
  double Done() const {
    const double by_steps =
        options_.steps > 0 ? static_cast<double>(state_.step) / options_.steps : 0.0;
    const double by_time = options_.minutes > 0 ? state_.seconds / (60.0 * options_.minutes) : 0.0;
    return std::max(by_steps, by_time);
  }

  double LearningRate() const {
    const double warm = std::min(1.0, (state_.step + 1.0) / std::max(1, options_.warmup_steps));
    const double cosine = 0.5 * (1.0 + std::cos(M_PI * std::min(1.0, Done())));
    return options_.learning_rate * warm * std::max(0.01, cosine);
  }

  Losses Step(const Tensor& batch) {
    for (auto& [name, tensor] : state_.network.Parameters()) {
      tensor->set_requires_grad(true);
      tensor->mutable_grad().reset();
    }
    Losses losses = Forward(batch);
    losses.total.backward();
    Update();
    return losses;
  }

  double ValidationLoss(const Tensor& maps) const {
    torch::NoGradGuard no_gradient;
    double sum = 0;
    for (int64_t i = 0; i < maps.size(0); ++i) {
      const Tensor one = maps.slice(0, i, i + 1);
      const Tensor z = state_.average.NormaliseByRunning(state_.average.EncodeRaw(one, compute_));
      sum += (state_.average.Decode(z, compute_) - one).abs().mean().item<double>();
    }
    return sum / static_cast<double>(maps.size(0));
  }

 private:
  Losses Forward(const Tensor& batch) {
    Losses losses;
    const int64_t count = batch.size(0);
    const int64_t twice = options_.smoothness > 0
                              ? std::lround(options_.smoothness_share * static_cast<double>(count))
                              : 0;
    const Tensor z = state_.network.NormaliseForTraining(
        state_.network.EncodeRaw(batch, compute_), kBatchStatisticsMomentum);
    Tensor codes = z;
    if (twice > 0) {
      auto generator = torch::make_generator<torch::CPUGeneratorImpl>(
          StreamSeed(options_.seed ^ kNoiseStream, static_cast<std::uint64_t>(state_.step)));
      const Tensor part = z.slice(0, 0, twice);
      const Tensor noise = torch::randn(part.sizes(), generator) * std::sqrt(options_.noise_variance);
      codes = torch::cat({z, part + noise}, 0);
    }
    const Tensor decoded = state_.network.Decode(codes, compute_);
    const Tensor plain = decoded.slice(0, 0, count);
    const Tensor map = ((plain - batch).abs() * map_weights_).mean();
    losses.map = map.item<double>();
    losses.total = map;
    if (twice > 0) {
      const Tensor moved = decoded.slice(0, count, count + twice) - decoded.slice(0, 0, twice);
      const Tensor smoothness = (moved.abs() * map_weights_).mean();
      losses.smoothness = smoothness.item<double>();
      losses.total = losses.total + options_.smoothness * smoothness;
    }
    if (options_.render_weight > 0 && options_.render_views > 0) {
      const Tensor render = RenderLoss(plain, batch);
      losses.render = render.item<double>();
      losses.total = losses.total + options_.render_weight * render;
    }
    return losses;
  }

  Tensor RenderLoss(const Tensor& decoded, const Tensor& truth) const {
    ViewBatch batch;
    batch.plane = {static_cast<int>(truth.size(3)), static_cast<int>(truth.size(2)), 2.0, 2.0,
                   TexelSampling::kPixelCentres};
    batch.convention = {DiffuseWeight::kOne, LightFalloff::kNone, TexelSampling::kPixelCentres};
    batch.views_per_element = options_.render_views;
    Stream random(StreamSeed(options_.seed ^ kViewStream, static_cast<std::uint64_t>(state_.step)));
    for (int64_t b = 0; b < truth.size(0); ++b) {
      const std::vector<View> views = DrawRenderLossViews(&random, options_.render_views);
      batch.views.insert(batch.views.end(), views.begin(), views.end());
    }
    return LogLossBetweenMaps(DecodeTexelsTorch(decoded), DecodeTexelsTorch(truth), batch, {});
  }

  void Update() {
    ++state_.step;
    const AdamOptions adam{LearningRate()};
    const double t = static_cast<double>(state_.step);
    const double decay = std::min(options_.average_decay, (1.0 + t) / (10.0 + t));
    auto network = state_.network.State();
    auto average = state_.average.State();
    for (size_t i = 0; i < network.size(); ++i) {
      Tensor weights = network[i].second->detach();
      if (i < state_.moment1.size()) {
        const Tensor g = network[i].second->grad().contiguous();
        AdamStep(adam, state_.step, Span(g), Span(weights), Span(state_.moment1[i]),
                 Span(state_.moment2[i]));
      }
      MoveAverage(decay, Span(weights), Span(*average[i].second));
    }
  }

  static std::span<float> Span(const Tensor& t) {
    return {t.data_ptr<float>(), static_cast<size_t>(t.numel())};
  }

  const TrainOptions options_;
  const torch::Dtype compute_;
  const Tensor map_weights_;
  TrainState state_;
};

Tensor ValidationMaps(const MaterialSource& source, int size) {
  Tensor maps = torch::empty({kValidationMaterials, kEncodedChannels, size, size});
  for (int k = 0; k < kValidationMaterials; ++k) {
    const EncodedMaps encoded = EncodeMaps(source(static_cast<std::uint64_t>(k)));
    if (encoded.planes.size() != static_cast<size_t>(maps[k].numel())) {
      throw std::runtime_error("validation material of another size");
    }
    std::copy(encoded.planes.begin(), encoded.planes.end(), maps[k].data_ptr<float>());
  }
  return maps;
}

class Log {
 public:
  Log(const std::filesystem::path& path, bool append)
      : out_(path, append ? std::ios::app : std::ios::trunc) {
    if (!append || out_.tellp() == 0) {
      out_ << "step,seconds,samples_per_second,learning_rate,loss,map,smoothness,render,validation\n";
    }
  }
  void Write(const TrainProgress& p) {
    out_ << p.step << ',' << std::fixed << std::setprecision(1) << p.seconds << ','
         << p.samples_per_second << ',' << std::defaultfloat << std::setprecision(6)
         << p.learning_rate << ',' << p.loss << ',' << p.map_loss << ',' << p.smoothness_loss << ','
         << p.render_loss << ',';
    if (p.validation_map_loss) out_ << *p.validation_map_loss;
    out_ << std::endl;
  }

 private:
  std::ofstream out_;
};

// Means of the losses since the last report.
class Window {
 public:
  void Add(const Losses& losses, double total) {
    sum_.loss += total;
    sum_.map_loss += losses.map;
    sum_.smoothness_loss += losses.smoothness;
    sum_.render_loss += losses.render;
    ++steps_;
  }
  int steps() const { return steps_; }
  TrainProgress Take() {
    TrainProgress mean = sum_;
    for (double* x : {&mean.loss, &mean.map_loss, &mean.smoothness_loss, &mean.render_loss}) {
      *x /= std::max(1, steps_);
    }
    sum_ = {};
    steps_ = 0;
    return mean;
  }

 private:
  TrainProgress sum_;
  int steps_ = 0;
};

void SaveAll(const TrainOptions& options, const TrainFiles& files, TrainState* state,
             double validation) {
  SaveCheckpoint(files.checkpoint, state);
  SaveNetwork(files.weights, &state->average,
              {{"data", options.data_name},
               {"seed", std::to_string(options.seed)},
               {"steps", std::to_string(state->step)},
               {"samples", std::to_string(state->step * options.batch)},
               {"validation_map_l1", std::to_string(validation)}});
}

constexpr int kPrincipalSamples = 192;

TrainState FirstState(const TrainOptions& options, MaterialPool* pool) {
  if (!options.principal_start) {
    return TrainState::From(AutoencoderNetwork::Random(options.channels, options.seed));
  }
  const int64_t crop = options.crop;
  Tensor samples = torch::empty({kPrincipalSamples, kEncodedChannels, crop, crop});
  pool->SampleFirst(kPrincipalSamples, options.crop,
                    {samples.data_ptr<float>(), static_cast<size_t>(samples.numel())});
  return TrainState::From(StartFromPrincipalComponents(options.channels, samples));
}

TrainFiles WithDefaults(TrainFiles files) {
  if (files.checkpoint.empty()) files.checkpoint = files.weights.string() + ".checkpoint";
  if (files.log_csv.empty()) files.log_csv = files.weights.string() + ".csv";
  return files;
}

}  // namespace

TrainProgress Train(const TrainOptions& options, const TrainFiles& given_files,
                    const MaterialSource& materials, const MaterialSource& validation,
                    const std::function<void(const TrainProgress&)>& report) {
  Check(options);
  torch::set_num_threads(options.threads);
  const TrainFiles files = WithDefaults(given_files);
  const bool resume = files.resume && std::filesystem::exists(files.checkpoint);
  std::optional<TrainState> resumed;
  if (resume) resumed = LoadCheckpoint(files.checkpoint, options.channels);
  PoolOptions pool_options = options.pool;
  pool_options.seed = options.seed;
  MaterialPool pool(pool_options, materials, resumed ? resumed->step : 0);
  Trainer trainer(options, resumed ? std::move(*resumed) : FirstState(options, &pool));
  TrainState* state = trainer.state();
  const Tensor validation_maps = ValidationMaps(validation, options.pool.material_size);
  Log log(files.log_csv, resume);

  Tensor batch = torch::empty({options.batch, kEncodedChannels, options.crop, options.crop});
  const std::span<float> values(batch.data_ptr<float>(), static_cast<size_t>(batch.numel()));
  Window window;
  TrainProgress progress;
  progress.validation_map_loss = trainer.ValidationLoss(validation_maps);
  if (report) report(progress);  // where it starts
  double tick = Now(), window_seconds = 0, since_checkpoint = 0;
  while (trainer.Done() < 1.0) {
    pool.Sample(state->step, options.batch, options.crop, values);
    const Losses losses = trainer.Step(batch);
    const double total = losses.total.item<double>();
    if (!std::isfinite(total)) {
      throw std::runtime_error("training: the loss is not finite at step " +
                               std::to_string(state->step) + "; resume with a lower --lr");
    }
    window.Add(losses, total);
    const double now = Now(), elapsed = now - tick;
    tick = now;
    state->seconds += elapsed;
    window_seconds += elapsed;
    since_checkpoint += elapsed;
    const bool last = trainer.Done() >= 1.0;
    const bool checkpoint = last || since_checkpoint > 60.0 * options.checkpoint_minutes;
    if (window_seconds < kReportSeconds && !checkpoint) continue;

    const int steps = window.steps();
    progress = window.Take();
    progress.step = state->step;
    progress.seconds = state->seconds;
    progress.samples_per_second = steps * options.batch / std::max(window_seconds, 1e-9);
    progress.learning_rate = trainer.LearningRate();
    progress.eta_seconds = state->seconds * (1.0 / std::max(trainer.Done(), 1e-9) - 1.0);
    if (checkpoint) {
      progress.validation_map_loss = trainer.ValidationLoss(validation_maps);
      SaveAll(options, files, state, *progress.validation_map_loss);
      since_checkpoint = 0;
    }
    window_seconds = 0;
    log.Write(progress);
    if (report) report(progress);
    tick = Now();  // validation and writing are not training time
  }
  return progress;
}

}  // namespace glint
