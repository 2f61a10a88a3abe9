// Texels that are solved together, one in each lane of the vector units, in single precision.
#pragma once

#include <array>
#include <vector>

#include "base/model/photographs.h"
#include "base/reflectance/lobe_mix.h"
#include "base/reflectance/view.h"
#include "fitting/texel/texel_albedos.h"
#include "fitting/texel/texel_parameters.h"
#include "fitting/texel/texel_prior.h"

namespace glint {

// As many as the widest vector units have lanes.
inline constexpr int kBatch = 16;

struct KernelOptions {
  DiffuseWeight diffuse_weight = DiffuseWeight::kOne;
  LobeMix<float> mix;                             // of the sample's specular lobes
  CharacteristicCurve curve;                      // of the photographs
  double robust_scale = constants::kRobustScale;  // δ (batch_kernel.h), in units of the logarithm
};

struct alignas(64) BatchRow {
  float lane[kBatch] = {};
  float& operator[](int i) { return lane[i]; }
  float operator[](int i) const { return lane[i]; }
};

struct BatchValues {
  BatchRow of[kTexelParameters];  // TexelParameter
};
void SetLane(int lane, const TexelValues& values, BatchValues* batch);
TexelValues ValuesOfLane(int lane, const BatchValues& batch);

// What is known of each lane beforehand (texel_prior.h): weights of departures, and means; of the
// slopes both are of n_x and n_y. Weight 0: nothing.
struct BatchPrior {
  BatchValues weight, mean;
  void SetLane(int lane, const TexelPrior& prior);
  void CopyLane(const BatchPrior& from, int from_lane, int lane);
};

// One view as the vector units take it.
struct BatchView {
  BatchView(const View& view, LightFalloff falloff);
  float camera_in_sample_mm[3], light_in_sample_mm[3];
  float exposed_light[3], exposed_ambient[3];
  float beam[2];
  bool inverse_square;
};

// What the lanes' residuals need from the photographs: a few planes for each view. All lanes have
// the same views; one that does not see a lane's texel weighs nothing there.
class BatchObservations {
 public:
  enum Plane : int {
    kLightX,  // unit, texel to light
    kLightY,
    kLightZ,
    kCameraX,  // unit, texel to camera
    kCameraY,
    kCameraZ,
    kHalfInverse,           // 1/|l+v|: the half vector is half_inverse·(l+v)
    kFresnel,               // the power of two in F
    kIrradiance,            // 3 planes: exposure·E
    kAmbient = 11,          // 3 planes: exposure·ambient, as the diffuse lobe receives it …
    kAmbientSpecular = 14,  // … 3 planes: and as the specular one does
    kLogTarget = 17,        // 3 planes: log(I + 0.01)
    kInverseTarget = 20,    // 3 planes: 1/(I + 0.01); I + 0.01 until Complete()
    kCeiling = 23,          // 3 planes: most the residual log(R + 0.01) − log(I + 0.01) can be; 0
                            // where the photograph clips: a brighter rendering satisfies it
    kWeight = 26,           // of the view's squared residuals
    kPlanes
  };

  explicit BatchObservations(int most_views);
  // From here on of so many views, none of which sees anything.
  void Clear(int views);
  void Place(int lane, double x_mm, double y_mm);
  // `radiance` linear, ≥ 0; `clipped`: the sensor's limit was reached in that channel; `weight` >
  // 0.
  void Set(int lane, int view, const float radiance[3], const bool clipped[3], double weight = 1);
  // Once for each view, after all of its radiances are set and before CopyLane(): what follows from
  // where each lane is.
  void Complete(int view, const BatchView& geometry);
  // After Complete(), in place of the view's own.
  void SetAmbient(int lane, int view, const double diffuse[3], const double specular[3]);
  void CopyLane(const BatchObservations& from, int from_lane, int lane);

  int views() const { return views_; }
  // How many views see a lane's texel.
  int seen(int lane) const { return seen_[static_cast<size_t>(lane)]; }
  bool sees(int view, int lane) const {
    return rows_[static_cast<size_t>(view) * kPlanes + kWeight][lane] > 0;
  }
  const BatchRow* rows() const { return rows_.data(); }  // [view][plane]

 private:
  BatchRow* view(int v) { return rows_.data() + static_cast<size_t>(v) * kPlanes; }

  BatchRow place_mm_[2];
  std::vector<BatchRow> rows_;
  std::array<int, kBatch> seen_{};
  int views_ = 0;
};

// Products of the residuals' derivatives and of the residuals themselves, upper triangles row by
// row: of each channel's two albedos with all else, and of roughness, slopes and residuals among
// themselves, summed over channels.
struct BatchGram {
  static constexpr int kOwn = 6 + 5, kShared = 4 + 3 + 2 + 1;
  BatchRow own[3][kOwn];
  BatchRow shared[kShared];
  double Squares(int lane) const { return shared[kShared - 1][lane]; }
};

// The inverse of normal equations, the prior included; symmetric.
struct BatchInverse {
  BatchRow of[kTexelParameters][kTexelParameters];
  double at(int i, int j, int lane) const { return of[i][j][lane]; }
};

// Each lane's residuals one by one, with their derivatives by the values; the two albedos are the
// channel's own.
class BatchResiduals {
 public:
  enum Row : int {
    kByDiffuse,
    kBySpecular,
    kByRough,
    kBySlopeX,
    kBySlopeY,
    kResidual,
    kDifference,  // log(R + 0.01) − log(I + 0.01), 0 where a clipped pixel is satisfied
    kRows
  };
  explicit BatchResiduals(int most_views) : rows_(static_cast<size_t>(3 * most_views) * kRows) {}
  double at(int view, int channel, Row row, int lane) const {
    return rows_[(3 * static_cast<size_t>(view) + static_cast<size_t>(channel)) * kRows + row]
                [lane];
  }
  BatchRow* rows() { return rows_.data(); }  // [view][channel][row]
  // Their products, summed in double precision: exactly those of these rows, for factors that
  // rounding must not make indefinite.
  TexelGram GramOf(int lane, int views) const;

 private:
  std::vector<BatchRow> rows_;
};

// AlbedoSums (texel_albedos.h) by channel, in its order.
struct BatchAlbedoSums {
  BatchRow of[3][6];
  AlbedoSums Of(int channel, int lane) const {
    const BatchRow* from = of[channel];
    return {from[0][lane], from[1][lane], from[2][lane],
            from[3][lane], from[4][lane], from[5][lane]};
  }
};

}  // namespace glint
