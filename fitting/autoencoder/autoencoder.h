// The trained auto-encoder as the rest of Glint uses it: maps to a code, a code to maps, and the
// gradient back to the code. No torch in this header.
//
// Source: Gao et al. 2019 (DIR), Fig. 3. Codes live on a grid 32 times coarser than the maps.
// Results are the same bits for any number of threads (on one machine; bf16 needs the CPU's
// support).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/reflectance/svbrdf_maps.h"
#include "fitting/encoding/encoding.h"

namespace glint {

struct LatentCode {
  int channels = 0;
  int height = 0;  // of the grid: maps' height / 32, rounded up
  int width = 0;
  std::vector<float> values;  // [channels, height, width]; about N(0, 1) for codes of materials
};

class Autoencoder {
 public:
  // Reads weights written by glint-train. Throws std::runtime_error "FILE: PART: found …; REMEDY".
  static Autoencoder Load(const std::filesystem::path& weights);
  // Untrained, for tests.
  static Autoencoder Random(const std::array<int, 5>& channels, std::uint64_t seed);

  ~Autoencoder();
  Autoencoder(Autoencoder&&) noexcept;
  Autoencoder& operator=(Autoencoder&&) noexcept;

  int latent_channels() const;

  // Any size from 1×1; sizes that are not multiples of 32 are continued by reflection. float32.
  LatentCode Encode(const SvbrdfMaps& maps, int threads) const;

  // The top left width × height texels of the decoded maps. float32. Throws std::invalid_argument
  // when the code is not of this network or its grid is too small.
  EncodedMaps Decode(const LatentCode& code, int width, int height, int threads) const;

  // The decoder's weights and biases as one vector, and the same network with others. Throws
  // std::invalid_argument for another number of them.
  std::vector<float> DecoderWeights() const;
  Autoencoder WithDecoder(std::span<const float> weights) const;

  // A decode that can be differentiated; keeps its buffers between calls.
  class Tape {
   public:
    // `fast`: multiplies in bf16 where the CPU does so natively. `network` must outlive the tape.
    Tape(const Autoencoder& network, bool fast, int threads);
    ~Tape();
    EncodedMaps Forward(const LatentCode& code, int width, int height);
    // ∂L/∂code of the last Forward from ∂L/∂encoded; in the code's layout.
    std::vector<float> Backward(const EncodedMaps& gradient);

    // The same with the decoder's weights free (laid out as DecoderWeights()): fine-tuning. The
    // gradient is by the code's values and then the weights.
    EncodedMaps ForwardTuned(const LatentCode& code, std::span<const float> weights, int width,
                             int height);
    std::vector<float> BackwardTuned(const EncodedMaps& gradient);

   private:
    struct State;
    std::unique_ptr<State> state_;
  };

 private:
  struct Impl;
  explicit Autoencoder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

inline constexpr char kAutoencoderModel[] = "autoencoder.safetensors";

}  // namespace glint
