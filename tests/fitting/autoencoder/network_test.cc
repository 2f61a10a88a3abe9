#include "fitting/autoencoder/network.h"

#include <gtest/gtest.h>

#include "fitting/autoencoder/autoencoder.h"
#include "fitting/encoding/encoding_torch.h"
#include "fitting/layers/layers.h"
#include "fitting/render/render_reference.h"
#include "tests/training/toy_materials.h"
#include "training/principal_start.h"

namespace glint {
namespace {

using torch::Tensor;

constexpr NetworkChannels kTiny{6, 8, 10, 12, 14};

LatentCode SomeCode(int channels, int height, int width) {
  Stream random(11);
  LatentCode code{channels, height, width, {}};
  code.values.resize(static_cast<size_t>(channels) * height * width);
  for (float& z : code.values) z = static_cast<float>(random.Normal());
  return code;
}

Tensor ToyBatch(int count, int size) {
  Tensor batch = torch::empty({count, kEncodedChannels, size, size});
  for (int k = 0; k < count; ++k) {
    const EncodedMaps maps = EncodeMaps(ToyMaterial(static_cast<std::uint64_t>(k), size, size));
    std::copy(maps.planes.begin(), maps.planes.end(), batch[k].data_ptr<float>());
  }
  return batch;
}

AutoencoderNetwork InDouble(AutoencoderNetwork network) {
  for (auto& [name, tensor] : network.State()) *tensor = tensor->to(torch::kFloat64);
  return network;
}

TEST(Network, AnySizeGoesInAndComesOut) {
  torch::set_num_threads(1);
  const Autoencoder network = Autoencoder::Random(kTiny, 1);
  for (const auto& [width, height] :
       {std::pair{1, 1}, {2, 31}, {32, 32}, {33, 64}, {100, 7}, {65, 130}}) {
    const LatentCode code = network.Encode(ToyMaterial(1, width, height), 1);
    EXPECT_EQ(code.width, (width + 31) / 32);
    EXPECT_EQ(code.height, (height + 31) / 32);
    EXPECT_EQ(code.channels, 14);
    const EncodedMaps maps = network.Decode(code, width, height, 1);
    EXPECT_EQ(maps.width, width);
    EXPECT_EQ(maps.height, height);
    for (const float t : maps.planes) ASSERT_LE(std::abs(t), 1.0f);
  }
}

TEST(Network, ACodeThatDoesNotFitIsRefused) {
  const Autoencoder network = Autoencoder::Random(kTiny, 1);
  EXPECT_THROW(network.Decode(SomeCode(13, 1, 1), 32, 32, 1), std::invalid_argument);
  EXPECT_THROW(network.Decode(SomeCode(14, 1, 1), 33, 32, 1), std::invalid_argument);
}

// The decoder's 2×2 convolution with interleaving is a 4×4 stride-2 transposed convolution.
TEST(Network, UpConvolutionIsTheTransposedConvolution) {
  AutoencoderNetwork network = InDouble(AutoencoderNetwork::Random(kTiny, 2));
  const Tensor z = torch::randn({2, 14, 2, 3}, torch::kFloat64);
  Tensor x = z;
  for (int i = 0; i < kLevels; ++i) {
    if (i > 0) x = at::leaky_relu(x, 0.2);
    const Tensor& w = network.decoder_weights[i];
    const int64_t out = w.size(0) / 4, in = w.size(1);
    Tensor kernel = torch::zeros({in, out, 4, 4}, torch::kFloat64);
    for (int a = 0; a < 2; ++a) {
      for (int b = 0; b < 2; ++b) {
        const Tensor phase =
            w.slice(0, (a * 2 + b) * out, (a * 2 + b + 1) * out).permute({1, 0, 2, 3});
        for (int u = 0; u < 2; ++u) {
          for (int v = 0; v < 2; ++v) {
            // Fine row 2i + 1 − a takes coarse row i + u − a by tap u.
            kernel.select(3, 2 - 2 * v + b).select(2, 2 - 2 * u + a) =
                phase.select(3, v).select(2, u);
          }
        }
      }
    }
    x = at::conv_transpose2d(x, kernel, {}, 2, 1);
  }
  EXPECT_LT((torch::tanh(x) - network.Decode(z, torch::kFloat64)).abs().max().item<double>(),
            1e-12);
}

TEST(Network, UpConvolutionOnGpusIsTheSame) {
  const Tensor x = torch::randn({2, 6, 3, 5}), weight = torch::randn({4 * 3, 6, 2, 2});
  const Tensor bias = torch::randn({4 * 3});
  const Tensor ours = UpConvolve(AsType(x, torch::kFloat32), weight, bias, torch::kFloat32);
  const Tensor theirs = InterleavedByTorch(at::conv2d(x, weight, bias, 1, 1));
  ASSERT_EQ(ours.sizes(), theirs.sizes());
  EXPECT_LT((ours - theirs).abs().max().item<float>(), 1e-5f);
}

TEST(Network, FusedDecodingOfTexelsAgreesWithTorchOperations) {
  const Tensor encoded = torch::rand({2, 9, 5, 7}) * 1.9 - 0.95;
  const Tensor weights = torch::randn({2, 10, 5, 7});
  Tensor a = encoded.clone().requires_grad_(), b = encoded.clone().requires_grad_();
  const Tensor fused = DecodeTexelsTorch(a), reference = DecodeTexelsReference(b);
  EXPECT_LT((fused - reference).abs().max().item<float>(), 1e-5);
  (fused * weights).sum().backward();
  (reference * weights).sum().backward();
  EXPECT_LT((a.grad() - b.grad()).abs().max().item<float>(), 1e-4);
}

// The whole chain that latent fitting differentiates: code → maps → renderings → log loss.
TEST(Network, GradientOfTheRenderingLossByTheCodeAgreesWithFiniteDifferences) {
  torch::manual_seed(3);
  torch::set_num_threads(1);
  const AutoencoderNetwork network = InDouble(StartFromPrincipalComponents(kTiny, ToyBatch(8, 32)));
  const Tensor z = torch::randn({1, 14, 1, 1}, torch::kFloat64) * 0.5;
  ViewBatch batch;
  batch.plane = {32, 32, 2, 2, TexelSampling::kPixelCentres};
  batch.convention = ReflectanceConvention::Dir2019();
  batch.views_per_element = 2;
  batch.views = {DirView(0, 0), DirView(0.7, -0.4)};
  const Tensor photographs = torch::rand({1, 2, 3, 32, 32}, torch::kFloat64) * 0.5 + 0.1;
  const auto loss = [&](const Tensor& code) {
    const Tensor maps = DecodeTexelsReference(network.Decode(code, torch::kFloat64));
    return LogLossReference(RenderReference(maps, {}, batch), photographs, {}, {});
  };
  const Tensor variable = z.clone().requires_grad_();
  loss(variable).backward();
  const Tensor gradient = variable.grad();
  for (int k = 0; k < 14; ++k) {
    const double step = 1e-7;
    Tensor up = z.clone(), down = z.clone();
    up[0][k][0][0] += step;
    down[0][k][0][0] -= step;
    const double slope = (loss(up) - loss(down)).item<double>() / (2 * step);
    const double exact = gradient[0][k][0][0].item<double>();
    EXPECT_NEAR(exact, slope, 1e-5 * std::max(0.01, std::abs(slope))) << k;
  }
}

TEST(Network, TapeDecodesAndDifferentiatesLikeTheNetwork) {
  const Autoencoder network = Autoencoder::Random(kTiny, 4);
  LatentCode code = SomeCode(14, 1, 2);
  Autoencoder::Tape tape(network, false, 1);
  const EncodedMaps maps = tape.Forward(code, 50, 20);
  const EncodedMaps plain = network.Decode(code, 50, 20, 1);
  for (size_t i = 0; i < maps.planes.size(); ++i)
    EXPECT_NEAR(maps.planes[i], plain.planes[i], 1e-6);

  EncodedMaps weights(50, 20);
  for (size_t i = 0; i < weights.planes.size(); ++i) weights.planes[i] = std::sin(i * 0.37f);
  const std::vector<float> gradient = tape.Backward(weights);
  for (const size_t k : {0u, 5u, 13u, 27u}) {
    double side[2];
    const float at = code.values[k], step = 2e-3f;
    for (int s = 0; s < 2; ++s) {
      code.values[k] = at + (s == 0 ? -step : step);
      const EncodedMaps moved = network.Decode(code, 50, 20, 1);
      side[s] = 0;
      for (size_t i = 0; i < moved.planes.size(); ++i) {
        side[s] += double{moved.planes[i]} * weights.planes[i];
      }
    }
    code.values[k] = at;
    const double slope = (side[1] - side[0]) / (2.0 * step);
    EXPECT_NEAR(gradient[k], slope, 0.05 * std::abs(slope) + 0.02) << k;
  }
}

// Widths and a size at which convolutions are really shared among threads, in both number formats.
TEST(Network, BitsDoNotDependOnThreads) {
  const Autoencoder network = Autoencoder::Random({32, 48, 64, 64, 64}, 5);
  const SvbrdfMaps material = ToyMaterial(2, 160, 96);
  const LatentCode code = network.Encode(material, 1);
  EXPECT_EQ(code.values, network.Encode(material, 2).values);
  EXPECT_EQ(network.Decode(code, 160, 96, 1).planes, network.Decode(code, 160, 96, 2).planes);
  for (const bool fast : {false, true}) {
    Autoencoder::Tape one(network, fast, 1), two(network, fast, 2);
    const EncodedMaps maps = one.Forward(code, 160, 96);
    EXPECT_EQ(maps.planes, two.Forward(code, 160, 96).planes) << fast;
    torch::set_num_threads(1);
    const std::vector<float> gradient = one.Backward(maps);
    torch::set_num_threads(2);
    EXPECT_EQ(gradient, two.Backward(maps)) << fast;
  }
}

TEST(Network, PrincipalComponentsPassDetailBeforeAnyTraining) {
  torch::set_num_threads(1);
  const Tensor batch = ToyBatch(12, 64);
  const AutoencoderNetwork network = StartFromPrincipalComponents({16, 24, 32, 48, 64}, batch);
  const Tensor z = network.NormaliseByRunning(network.EncodeRaw(batch, torch::kFloat32));
  const double error = (network.Decode(z, torch::kFloat32) - batch).abs().mean().item<double>();
  const Tensor means = batch.mean(c10::IntArrayRef{2, 3}, true);
  const double flat = (means - batch).abs().mean().item<double>();
  EXPECT_LT(error, 0.6 * flat);
}

TEST(Network, CodesOfTheTrainingSamplesAreNormal) {
  const Tensor batch = ToyBatch(12, 64);
  AutoencoderNetwork network = StartFromPrincipalComponents(kTiny, batch);
  const Tensor raw = network.EncodeRaw(batch, torch::kFloat32);
  const Tensor running = network.NormaliseByRunning(raw);
  EXPECT_NEAR(running.mean().item<double>(), 0.0, 0.02);
  EXPECT_NEAR(running.square().mean().item<double>(), 1.0, 0.05);
  // In training the values are the same; only their gradient knows of the batch.
  const Tensor training = network.NormaliseForTraining(raw, 0.01);
  EXPECT_LT((training - running).abs().max().item<double>(), 1e-3);
}

TEST(PrincipalStart, WithoutNormalisationIsTheSameFunction) {
  const Tensor batch = ToyBatch(6, 64);
  const AutoencoderNetwork with = StartFromPrincipalComponents(kTiny, batch);
  const AutoencoderNetwork without =
      StartFromPrincipalComponents(kTiny, batch, Normalisation::kNone);
  const auto code = [&](const AutoencoderNetwork& network) {
    return network.NormaliseByRunning(network.EncodeRaw(batch, torch::kFloat32));
  };
  const Tensor a = code(with), b = code(without);
  EXPECT_TRUE(torch::allclose(a, b, 1e-3, 2e-3));
  EXPECT_TRUE(torch::allclose(with.Decode(a, torch::kFloat32), without.Decode(b, torch::kFloat32),
                              1e-3, 2e-3));
  EXPECT_THROW(StartFromPrincipalComponents(kTiny, batch, Normalisation::kAll),
               std::invalid_argument);
}

TEST(Layers, ChangingTypeAndLayoutAtOnceChangesNoValue) {
  const Tensor kernel = torch::randn({5, 3, 4, 4});
  for (const auto type : {torch::kBFloat16, torch::kFloat32, torch::kFloat64}) {
    const Tensor changed = AsType(kernel, type);
    EXPECT_TRUE(changed.is_contiguous(torch::MemoryFormat::ChannelsLast));
    EXPECT_EQ(changed.scalar_type(), type);
    EXPECT_TRUE(torch::equal(changed, kernel.to(type)));
  }
}

}  // namespace
}  // namespace glint
