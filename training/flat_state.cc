#include "training/flat_state.h"

namespace glint {
namespace {

using torch::Tensor;

// Views begin at multiples of so many values: whatever alignment vector instructions want.
constexpr int64_t kAlignment = 64;

int64_t Padded(int64_t values) { return (values + kAlignment - 1) / kAlignment * kAlignment; }

// Hands out consecutive views of a buffer.
class Cutter {
 public:
  explicit Cutter(Tensor buffer) : buffer_(std::move(buffer)) {}
  Tensor Next(const Tensor& like) {
    const Tensor view = buffer_.slice(0, at_, at_ + like.numel()).view(like.sizes());
    at_ += Padded(like.numel());
    return view;
  }

 private:
  Tensor buffer_;
  int64_t at_ = 0;
};

}  // namespace

FlatState::FlatState(TrainState* state) {
  torch::NoGradGuard no_gradient;
  const size_t learned = state->moment1.size();
  int64_t size = 0;
  for (size_t i = 0; i < learned; ++i) size += Padded(state->network[i].second->numel());
  const auto options = learned > 0 ? state->network[0].second->detach().options() : torch::kFloat32;
  for (Tensor* buffer : {&weights, &average, &moment1, &moment2, &gradients}) {
    *buffer = torch::zeros({size}, options);
  }
  const auto move = [&](const Tensor& buffer, const auto& tensor_of) {
    Cutter cutter(buffer);
    for (size_t i = 0; i < learned; ++i) {
      Tensor* tensor = tensor_of(i);
      const Tensor view = cutter.Next(*tensor);
      view.copy_(*tensor);
      *tensor = view.detach();
    }
  };
  move(weights, [&](size_t i) { return state->network[i].second; });
  move(average, [&](size_t i) { return state->average[i].second; });
  move(moment1, [&](size_t i) { return &state->moment1[i]; });
  move(moment2, [&](size_t i) { return &state->moment2[i]; });
  Cutter cutter(gradients);
  for (size_t i = 0; i < learned; ++i) {
    Tensor* tensor = state->network[i].second;
    tensor->set_requires_grad(true);
    tensor->mutable_grad() = cutter.Next(*tensor);
  }
}

Snapshot::Snapshot(const FlatState& flat, const TrainState& state)
    : weights_(flat.weights.clone()),
      average_(flat.average.clone()),
      moment1_(flat.moment1.clone()),
      moment2_(flat.moment2.clone()),
      step_(state.step) {
  for (size_t i = state.moment1.size(); i < state.network.size(); ++i) {
    other_.push_back(state.network[i].second->detach().clone());
    other_average_.push_back(state.average[i].second->detach().clone());
  }
}

void Snapshot::Restore(FlatState* flat, TrainState* state) const {
  torch::NoGradGuard no_gradient;
  flat->weights.copy_(weights_);
  flat->average.copy_(average_);
  flat->moment1.copy_(moment1_);
  flat->moment2.copy_(moment2_);
  for (size_t i = 0; i < other_.size(); ++i) {
    state->network[state->moment1.size() + i].second->copy_(other_[i]);
    state->average[state->moment1.size() + i].second->copy_(other_average_[i]);
  }
  state->step = step_;
}

}  // namespace glint
