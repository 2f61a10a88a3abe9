#include "fitting/autoencoder/autoencoder.h"

#include <algorithm>
#include <stdexcept>

#include "fitting/autoencoder/network.h"
#include "fitting/autoencoder/network_file.h"
#include "fitting/encoding/encoding_torch.h"
#include "fitting/layers/layers.h"
#include "fitting/layers/threads.h"

namespace glint {
namespace {

using torch::Tensor;

int Cells(int texels) { return (texels + kDownsampling - 1) / kDownsampling; }

// Index into n texels of position i ≥ 0 when the texels go on as in a mirror: 0 1 2 1 0 1 2 …
int Reflected(int i, int n) {
  if (n == 1) return 0;
  const int period = 2 * (n - 1);
  const int k = i % period;
  return k < n ? k : period - k;
}

Tensor PaddedTensor(const EncodedMaps& maps) {
  const int height = Cells(maps.height) * kDownsampling, width = Cells(maps.width) * kDownsampling;
  Tensor padded = torch::empty({1, kEncodedChannels, height, width});
  float* to = padded.data_ptr<float>();
  for (int p = 0; p < kEncodedChannels; ++p) {
    // A mirror turns a slope across it; the channel's own sign is enough, its place follows.
    for (int row = 0; row < height; ++row) {
      const bool mirrored_y = row >= maps.height && (row / std::max(1, maps.height - 1)) % 2 == 1;
      const size_t source_row = static_cast<size_t>(Reflected(row, maps.height));
      const float* from = maps.planes.data() + p * maps.texels() + source_row * maps.width;
      for (int column = 0; column < width; ++column) {
        const bool mirrored_x =
            column >= maps.width && (column / std::max(1, maps.width - 1)) % 2 == 1;
        const bool turned =
            (p == kEncodedNormal && mirrored_x) || (p == kEncodedNormal + 1 && mirrored_y);
        const float value = from[Reflected(column, maps.width)];
        *to++ = turned ? -value : value;
      }
    }
  }
  return padded;
}

Tensor CodeTensor(const LatentCode& code) {
  Tensor z = torch::empty({1, code.channels, code.height, code.width});
  std::copy(code.values.begin(), code.values.end(), z.data_ptr<float>());
  return z;
}

void CheckCode(const LatentCode& code, int channels, int width, int height) {
  const size_t values = static_cast<size_t>(code.channels) * code.height * code.width;
  if (code.channels != channels || code.values.size() != values || width < 1 || height < 1 ||
      width > code.width * kDownsampling || height > code.height * kDownsampling) {
    throw std::invalid_argument(
        "Autoencoder: the latent code does not fit the network or the size");
  }
}

std::vector<Tensor> DecoderTensors(const AutoencoderNetwork& network) {
  std::vector<Tensor> tensors;
  for (int i = 0; i < kLevels; ++i) {
    tensors.push_back(network.decoder_weights[i]);
    tensors.push_back(network.decoder_biases[i]);
  }
  return tensors;
}

// New tensors, so that a graph that still holds the old ones is not changed.
void SetDecoder(std::span<const float> weights, AutoencoderNetwork* network) {
  size_t at = 0;
  const auto take = [&](Tensor* tensor) {
    const size_t count = static_cast<size_t>(tensor->numel());
    if (at + count > weights.size()) throw std::invalid_argument("Autoencoder: too few weights");
    const Tensor fresh = torch::empty(tensor->sizes().vec());
    std::copy_n(weights.begin() + static_cast<std::ptrdiff_t>(at), count, fresh.data_ptr<float>());
    *tensor = fresh;
    at += count;
  };
  for (int i = 0; i < kLevels; ++i) {
    take(&network->decoder_weights[i]);
    take(&network->decoder_biases[i]);
  }
  if (at != weights.size()) throw std::invalid_argument("Autoencoder: too many weights");
}

}  // namespace

struct Autoencoder::Impl {
  AutoencoderNetwork network;
};

Autoencoder::Autoencoder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Autoencoder::~Autoencoder() = default;
Autoencoder::Autoencoder(Autoencoder&&) noexcept = default;
Autoencoder& Autoencoder::operator=(Autoencoder&&) noexcept = default;

Autoencoder Autoencoder::Load(const std::filesystem::path& weights) {
  return Autoencoder(std::make_unique<Impl>(Impl{LoadNetwork(weights)}));
}

Autoencoder Autoencoder::Random(const std::array<int, 5>& channels, std::uint64_t seed) {
  return Autoencoder(std::make_unique<Impl>(Impl{AutoencoderNetwork::Random(channels, seed)}));
}

int Autoencoder::latent_channels() const { return impl_->network.channels[kLevels - 1]; }

LatentCode Autoencoder::Encode(const SvbrdfMaps& maps, int threads) const {
  if (maps.width < 1 || maps.height < 1) {
    throw std::invalid_argument("Autoencoder: maps without texels");
  }
  torch::NoGradGuard no_gradient;
  UseThreads(threads);
  const Tensor raw = impl_->network.EncodeRaw(PaddedTensor(EncodeMaps(maps)), torch::kFloat32);
  const Tensor z = impl_->network.NormaliseByRunning(raw).contiguous();
  LatentCode code{
      static_cast<int>(z.size(1)), static_cast<int>(z.size(2)), static_cast<int>(z.size(3)), {}};
  code.values.assign(z.data_ptr<float>(), z.data_ptr<float>() + z.numel());
  return code;
}

EncodedMaps Autoencoder::Decode(const LatentCode& code, int width, int height, int threads) const {
  CheckCode(code, latent_channels(), width, height);
  torch::NoGradGuard no_gradient;
  UseThreads(threads);
  return CroppedMaps(impl_->network.Decode(CodeTensor(code), torch::kFloat32), width, height);
}

std::vector<float> Autoencoder::DecoderWeights() const {
  std::vector<float> weights;
  for (const Tensor& t : DecoderTensors(impl_->network)) {
    const Tensor values = t.contiguous();
    weights.insert(weights.end(), values.data_ptr<float>(),
                   values.data_ptr<float>() + values.numel());
  }
  return weights;
}

Autoencoder Autoencoder::WithDecoder(std::span<const float> weights) const {
  auto impl = std::make_unique<Impl>(Impl{Clone(&impl_->network)});
  SetDecoder(weights, &impl->network);
  return Autoencoder(std::move(impl));
}

struct Autoencoder::Tape::State {
  AutoencoderNetwork network;  // its decoder in the type `compute`
  AutoencoderNetwork tuned;    // its decoder in float32, for ForwardTuned
  torch::Dtype compute;
  int threads;
  Tensor z, decoded;
};

Autoencoder::Tape::Tape(const Autoencoder& network, bool fast, int threads)
    : state_(std::make_unique<State>()) {
  state_->network = network.impl_->network;
  state_->tuned = Clone(&network.impl_->network);
  state_->compute = fast ? FastComputeType() : torch::kFloat32;
  state_->threads = threads;
  for (int i = 0; i < kLevels; ++i) {  // cast once, not at every decode
    Tensor& weight = state_->network.decoder_weights[i];
    weight = weight.to(state_->compute).contiguous(torch::MemoryFormat::ChannelsLast);
    Tensor& bias = state_->network.decoder_biases[i];
    bias = bias.to(state_->compute);
  }
}

Autoencoder::Tape::~Tape() = default;

namespace {

// ∂L/∂inputs, one after the other, from ∂L/∂encoded of the top left texels.
std::vector<float> PullBack(const Tensor& decoded, const std::vector<Tensor>& inputs,
                            const EncodedMaps& gradient) {
  Tensor full = torch::zeros_like(decoded, torch::MemoryFormat::Contiguous);
  const int64_t height = full.size(2), width = full.size(3);
  const float* from = gradient.planes.data();
  for (int p = 0; p < kEncodedChannels; ++p) {
    for (int row = 0; row < gradient.height; ++row, from += gradient.width) {
      std::copy_n(from, gradient.width, full.data_ptr<float>() + (p * height + row) * width);
    }
  }
  std::vector<float> all;
  for (const Tensor& part : torch::autograd::grad({decoded}, inputs, {full})) {
    const Tensor g = part.contiguous();
    all.insert(all.end(), g.data_ptr<float>(), g.data_ptr<float>() + g.numel());
  }
  return all;
}

}  // namespace

EncodedMaps Autoencoder::Tape::Forward(const LatentCode& code, int width, int height) {
  CheckCode(code, state_->network.channels[kLevels - 1], width, height);
  UseThreads(state_->threads);
  state_->z = CodeTensor(code).requires_grad_();
  state_->decoded = state_->network.Decode(state_->z, state_->compute);
  return CroppedMaps(state_->decoded.detach(), width, height);
}

std::vector<float> Autoencoder::Tape::Backward(const EncodedMaps& gradient) {
  if (!state_->decoded.defined()) throw std::logic_error("Tape::Backward before Forward");
  const Tensor decoded = std::move(state_->decoded);
  state_->decoded = Tensor();
  return PullBack(decoded, {state_->z}, gradient);
}

EncodedMaps Autoencoder::Tape::ForwardTuned(const LatentCode& code, std::span<const float> weights,
                                            int width, int height) {
  CheckCode(code, state_->network.channels[kLevels - 1], width, height);
  UseThreads(state_->threads);
  SetDecoder(weights, &state_->tuned);
  for (const Tensor& t : DecoderTensors(state_->tuned)) t.set_requires_grad(true);
  state_->z = CodeTensor(code).requires_grad_();
  state_->decoded = state_->tuned.Decode(state_->z, state_->compute);
  return CroppedMaps(state_->decoded.detach(), width, height);
}

std::vector<float> Autoencoder::Tape::BackwardTuned(const EncodedMaps& gradient) {
  if (!state_->decoded.defined()) throw std::logic_error("Tape::BackwardTuned before ForwardTuned");
  const Tensor decoded = std::move(state_->decoded);
  state_->decoded = Tensor();
  std::vector<Tensor> inputs = DecoderTensors(state_->tuned);
  inputs.insert(inputs.begin(), state_->z);
  return PullBack(decoded, inputs, gradient);
}

}  // namespace glint
