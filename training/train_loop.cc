#include "training/train_loop.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <optional>
#include <stdexcept>

#include "fitting/autoencoder/adam.h"
#include "training/checkpoint.h"
#include "training/flat_state.h"
#include "training/loss_plot.h"
#include "training/supervisor.h"

namespace glint {
namespace {

using torch::Tensor;

constexpr int kCropMultiple = 32;

double Now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

void CheckTrainOptions(const TrainOptions& o) {
  const auto require = [](bool good, const std::string& message) {
    if (!good) throw std::runtime_error("training options: " + message);
  };
  require(o.steps > 0 || o.minutes > 0, "found neither steps nor minutes; give one of them");
  require(o.batch >= 1 && o.batch <= 4096,
          "found batch " + std::to_string(o.batch) + "; it must be 1 to 4096");
  require(!o.crops.empty(), "found no crop size; give one or more");
  for (const int crop : o.crops) {
    require(crop >= kCropMultiple && crop % kCropMultiple == 0 && crop <= o.pool.material_size,
            "found crop " + std::to_string(crop) +
                "; it must be a multiple of 32 that fits the materials");
  }
  require(o.render_weight >= 0 && o.map_weight >= 0 && o.render_weight + o.map_weight > 0,
          "found weights of maps and renderings below 0, or both 0; give one of them");
  require(o.accumulate >= 1 && o.accumulate <= 1024,
          "found accumulate " + std::to_string(o.accumulate) + "; it must be 1 to 1024");
  require(o.threads >= 1, "found threads below 1");
  require(o.device == "cpu" || o.device == "cuda",
          "found device " + o.device + "; it must be cpu or cuda");
  require(o.device == "cpu" || torch::cuda::is_available(),
          "found device cuda, and no GPU that this libtorch can use; take cpu");
}

namespace {

std::span<float> Span(const Tensor& t) {
  return {t.data_ptr<float>(), static_cast<size_t>(t.numel())};
}

class Log {
 public:
  Log(const std::filesystem::path& path, bool append)
      : out_(path, append ? std::ios::app : std::ios::trunc) {
    if (!append || out_.tellp() == 0) {
      out_ << "step,seconds,samples_per_second,learning_rate,loss,map,smoothness,render,"
              "validation\n";
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
  void Add(const StepLosses& losses) {
    AddTo(losses.total.detach(), &total_);
    AddTo(losses.map, &map_);
    AddTo(losses.smoothness, &smoothness_);
    AddTo(losses.render, &render_);
    ++batches_;
  }
  int batches() const { return batches_; }
  TrainProgress Take() {
    TrainProgress mean;
    mean.loss = Mean(total_);
    mean.map_loss = Mean(map_);
    mean.smoothness_loss = Mean(smoothness_);
    mean.render_loss = Mean(render_);
    *this = {};
    return mean;
  }

 private:
  // Sums stay on the training's device: to read one waits for all that is under way there.
  static void AddTo(const Tensor& loss, Tensor* sum) {
    if (loss.defined()) *sum = sum->defined() ? *sum + loss : loss;
  }
  double Mean(const Tensor& sum) const {
    return sum.defined() ? sum.item<double>() / std::max(1, batches_) : 0;
  }

  Tensor total_, map_, smoothness_, render_;
  int batches_ = 0;
};

// A copy of the last checkpoint beside it, for when a training does not get on from the next one.
void KeepPrevious(const std::filesystem::path& checkpoint) {
  if (!std::filesystem::exists(checkpoint)) return;
  const std::filesystem::path copy = checkpoint.string() + ".previous";
  const std::filesystem::path beside = copy.string() + ".tmp";
  std::filesystem::copy_file(checkpoint, beside, std::filesystem::copy_options::overwrite_existing);
  std::filesystem::rename(beside, copy);
}

// The weights and Adam's state as they stand, or as the checkpoint has them.
TrainState BeginningOf(const TrainOptions& options, const TrainFiles& files, Trainable* trainable) {
  TrainState state =
      TrainState::From(trainable->State(), trainable->AverageState(), trainable->learned());
  if (files.resume && std::filesystem::exists(files.CheckpointPath())) {
    LoadCheckpoint(files.CheckpointPath(), trainable->Description(), options.accumulate, &state);
  }
  return state;
}

class Loop {
 public:
  Loop(const TrainOptions& options, const TrainFiles& files, Trainable* trainable)
      : options_(options),
        files_(files),
        trainable_(trainable),
        state_(BeginningOf(options, files, trainable)),
        flat_(&state_) {
    if (options.supervise) supervisor_.emplace(files.resume ? files.LogPath() : "", flat_, state_);
  }

  TrainProgress Run(const TrainReport& report) {
    Log log(files_.LogPath(), files_.resume);
    TrainProgress progress;
    progress.step = state_.step;
    progress.validation_map_loss = trainable_->Validate();
    if (report) report(progress);  // where it starts
    double tick = Now(), window_seconds = 0, since_checkpoint = 0;
    while (Done() < 1.0) {
      Step();
      const double now = Now(), elapsed = now - tick;
      tick = now;
      state_.seconds += elapsed;
      window_seconds += elapsed;
      since_checkpoint += elapsed;
      const bool last = Done() >= 1.0;
      const bool due = last || since_checkpoint > 60.0 * options_.checkpoint_minutes;
      if (window_seconds < options_.report_seconds && !due) continue;
      progress = Report(window_seconds);
      // A checkpoint waits for a loss that is beyond doubt; the last one is of weights that were.
      const bool good = Supervise(last, &progress);
      const bool checkpoint = due && (good || last);
      if (checkpoint) {
        progress.validation_map_loss = trainable_->Validate();
        Save(*progress.validation_map_loss);
        since_checkpoint = 0;
      }
      window_seconds = 0;
      log.Write(progress);
      if (checkpoint) WriteLossPlot(files_.LogPath(), files_.PlotPath());
      if (report) report(progress);
      tick = Now();  // validation and writing are not training time
      if (last) break;
    }
    return progress;
  }

 private:
  // Fraction of the training that is over.
  double Done() const {
    const double by_steps =
        options_.steps > 0 ? static_cast<double>(state_.step) / options_.steps : 0.0;
    const double by_time = options_.minutes > 0 ? state_.seconds / (60.0 * options_.minutes) : 0.0;
    return std::max(by_steps, by_time);
  }

  double LearningRate() const {
    const double since = static_cast<double>(state_.step - options_.warmup_from);
    const double warm = std::clamp((since + 1) / std::max(1, options_.warmup_steps), 0.01, 1.0);
    const double cosine = 0.5 * (1.0 + std::cos(M_PI * std::min(1.0, Done())));
    return options_.learning_rate * state_.rate_factor * warm * std::max(0.01, cosine);
  }

  void Step() {
    flat_.gradients.zero_();
    for (int k = 0; k < options_.accumulate; ++k) {
      const StepLosses losses = trainable_->Forward(state_.batch++);
      (losses.total / options_.accumulate).backward();
      window_.Add(losses);
    }
    Update();
    if (state_.step == options_.test_jump_step && !spoilt_) {
      constexpr double kSpoilt = 20;  // puts the outputs at the ends of their ranges
      flat_.weights.mul_(kSpoilt);
      spoilt_ = true;
    }
  }

  void Update() {
    torch::NoGradGuard no_gradient;
    ++state_.step;
    if (options_.max_gradient_norm > 0) {
      flat_.gradients.mul_(
          (options_.max_gradient_norm / flat_.gradients.norm().clamp_min(1e-12)).clamp_max(1));
    }
    const double t = static_cast<double>(state_.step);
    const double decay = std::min(options_.average_decay, (1.0 + t) / (10.0 + t));
    Learn({LearningRate()});
    Average(decay, flat_.weights, flat_.average);
    for (size_t i = state_.moment1.size(); i < state_.network.size(); ++i) {
      Average(decay, state_.network[i].second->detach(), *state_.average[i].second);
    }
  }

  // One step of Adam (adam.h), there or by torch's operations.
  void Learn(const AdamOptions& adam) {
    if (flat_.weights.device().is_cpu()) {
      AdamStep(adam, state_.step, Span(flat_.gradients), Span(flat_.weights), Span(flat_.moment1),
               Span(flat_.moment2));
      return;
    }
    const double t = static_cast<double>(state_.step);
    flat_.moment1.lerp_(flat_.gradients, 1 - adam.beta1);
    flat_.moment2.mul_(adam.beta2).addcmul_(flat_.gradients, flat_.gradients, 1 - adam.beta2);
    const Tensor scale = (flat_.moment2 / (1 - std::pow(adam.beta2, t))).sqrt_().add_(adam.epsilon);
    flat_.weights.addcdiv_(flat_.moment1, scale,
                           -adam.learning_rate / (1 - std::pow(adam.beta1, t)));
  }

  static void Average(double decay, const Tensor& weights, Tensor average) {
    if (weights.device().is_cpu()) {
      MoveAverage(decay, Span(weights), Span(average));
    } else {
      average.lerp_(weights, 1 - decay);
    }
  }

  // Whether the weights are beyond doubt; takes them back where the loss has jumped, or is doubtful
  // at the end.
  bool Supervise(bool last, TrainProgress* progress) {
    if (!supervisor_) {
      if (!std::isfinite(progress->loss)) {
        throw std::runtime_error("training: the loss is not finite before step " +
                                 std::to_string(state_.step) +
                                 "; resume with a lower --lr, or give --supervise");
      }
      return true;
    }
    const double loss =
        std::isfinite(progress->loss) ? progress->map_loss + progress->render_loss : progress->loss;
    const LossVerdict verdict = supervisor_->Judge(loss, flat_, state_);
    if (verdict == LossVerdict::kCalm) return true;
    if (verdict == LossVerdict::kSuspicious && !last) return false;
    progress->event = supervisor_->GoBack(&flat_, &state_);
    return false;
  }

  TrainProgress Report(double window_seconds) {
    const int batches = window_.batches();
    TrainProgress progress = window_.Take();
    progress.step = state_.step;
    progress.seconds = state_.seconds;
    progress.samples_per_second =
        batches * trainable_->samples_per_batch() / std::max(window_seconds, 1e-9);
    const double waited = trainable_->waited_seconds();
    progress.wait_share = (waited - waited_seconds_) / std::max(window_seconds, 1e-9);
    waited_seconds_ = waited;
    progress.learning_rate = LearningRate();
    progress.eta_seconds = state_.seconds * (1.0 / std::max(Done(), 1e-9) - 1.0);
    return progress;
  }

  void Save(double validation) {
    if (options_.supervise) KeepPrevious(files_.CheckpointPath());
    SaveCheckpoint(files_.CheckpointPath(), state_, trainable_->Description());
    std::map<std::string, std::string> metadata{
        {"data", options_.data_name},
        {"seed", std::to_string(options_.seed)},
        {"steps", std::to_string(state_.step)},
        {"samples",
         std::to_string(std::llround(static_cast<double>(state_.step) * options_.accumulate *
                                     trainable_->samples_per_batch()))},
        {"validation_map_l1", std::to_string(validation)}};
    if (!options_.from.empty()) metadata["from"] = options_.from.filename().string();
    if (!files_.float32.empty()) trainable_->SaveWeights(files_.float32, metadata, false);
    trainable_->SaveWeights(files_.weights, std::move(metadata), true);
  }

  const TrainOptions& options_;
  const TrainFiles& files_;
  Trainable* trainable_;
  TrainState state_;
  FlatState flat_;
  std::optional<Supervisor> supervisor_;
  Window window_;
  double waited_seconds_ = 0;
  bool spoilt_ = false;
};

}  // namespace

std::filesystem::path TrainFiles::CheckpointPath() const {
  return checkpoint.empty() ? weights.string() + ".checkpoint" : checkpoint.string();
}

std::filesystem::path TrainFiles::LogPath() const {
  return log_csv.empty() ? weights.string() + ".csv" : log_csv.string();
}

std::filesystem::path TrainFiles::PlotPath() const {
  return std::filesystem::path(LogPath()).replace_extension(".svg");
}

std::int64_t FirstBatch(const TrainOptions& options, const TrainFiles& files) {
  const std::filesystem::path path = files.CheckpointPath();
  return files.resume && std::filesystem::exists(path) ? CheckpointBatch(path, options.accumulate)
                                                       : 0;
}

TrainProgress RunTraining(const TrainOptions& options, const TrainFiles& files,
                          Trainable* trainable, const TrainReport& report) {
  return Loop(options, files, trainable).Run(report);
}

}  // namespace glint
