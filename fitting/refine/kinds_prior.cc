#include "fitting/refine/kinds_prior.h"

#include <algorithm>
#include <cmath>

#include "base/model/solver.h"
#include "base/model/substances.h"

namespace glint {
namespace {

using constants::kBlackSpecular;
using constants::kColouredChromaSd;
using constants::kGreyChromaSd;

constexpr double kCertain = 500;  // of a logarithm, that its exponential is finite

struct Look {
  explicit Look(const SpecularMean& mean)
      : grey(mean.mean()),
        log_grey(std::log(grey + kBlackSpecular)),
        size(grey + kSpecularOffset),
        departures((mean.array() - grey).square().sum() / (size * size)) {}

  double grey, log_grey;
  double size;        // that departures are relative to
  double departures;  // of channels, squared
};

// Logarithms of densities, up to common constants.
double OfSpecular(const MaterialKind& kind, double log_grey) {
  const double off = (log_grey - std::log(kind.f0)) / kind.log_spread;
  return -0.5 * off * off - std::log(kind.log_spread);
}
double OfChroma(double spread, double departures) {  // of which two are free
  return -0.5 * departures / (spread * spread) - 2 * std::log(spread);
}

// What a substance probably is.
struct Probabilities {
  Probabilities(const Look& look, double log_power, double metal_share) {
    // Relative to a grey dielectric.
    const double colour =
        std::exp(std::min(kCertain, OfChroma(kColouredChromaSd, look.departures) -
                                        OfChroma(kGreyChromaSd, look.departures)));
    const double dielectric_coloured =
        kDielectric.coloured_share / (1 - kDielectric.coloured_share) * colour;
    const double log_grey = look.log_grey - log_power;
    const double metal = metal_share / (1 - metal_share) / (1 - kDielectric.coloured_share) *
                         std::exp(OfSpecular(kMetal, log_grey) - OfSpecular(kDielectric, log_grey));
    const double metal_coloured = metal * kMetal.coloured_share * colour;
    const double sum =
        1 + dielectric_coloured + metal * (1 - kMetal.coloured_share) + metal_coloured;
    of_dielectric = (1 + dielectric_coloured) / sum;
    of_coloured = (dielectric_coloured + metal_coloured) / sum;
  }

  double of_dielectric, of_coloured;
};

double PrecisionOf(double first_share, double first_spread, double second_spread) {
  return first_share / (first_spread * first_spread) +
         (1 - first_share) / (second_spread * second_spread);
}

// Gaussians of a substance's logarithm and of its channels' departures.
struct Expected {
  explicit Expected(const Probabilities& is)
      : log_precision(PrecisionOf(is.of_dielectric, kDielectric.log_spread, kMetal.log_spread)),
        chroma_precision(PrecisionOf(is.of_coloured, kColouredChromaSd, kGreyChromaSd)) {
    const double dielectric =
        is.of_dielectric / (kDielectric.log_spread * kDielectric.log_spread) / log_precision;
    log_grey = dielectric * std::log(kDielectric.f0) + (1 - dielectric) * std::log(kMetal.f0);
  }

  double log_precision, chroma_precision, log_grey;
};

}  // namespace

KindsPrior PriorOfKinds(const std::vector<SpecularMean>& means, const KindsPriorOptions& options) {
  const std::vector<Look> looks(means.begin(), means.end());
  const double power_precision = 1 / (options.light_power_spread * options.light_power_spread);
  const auto count = static_cast<Eigen::Index>(looks.size());
  Eigen::VectorXd off(count), precision(count), by_chroma(count);
  double log_power = 0;
  for (int round = 0; round < constants::kKindsRounds; ++round) {
    for (Eigen::Index k = 0; k < count; ++k) {
      const Look& look = looks[static_cast<size_t>(k)];
      const Expected expected(Probabilities(look, log_power, options.metal_share));
      off[k] = look.log_grey - expected.log_grey;
      precision[k] = expected.log_precision;
      by_chroma[k] = expected.chroma_precision / (look.size * look.size);
    }
    log_power = precision.dot(off) / (power_precision + precision.sum());
  }
  Eigen::MatrixXd joint = precision.asDiagonal();
  joint -= precision * precision.transpose() / (power_precision + precision.sum());
  const Eigen::VectorXd pull = -(joint * off);

  KindsPrior prior{Eigen::MatrixXd::Zero(3 * count, 3 * count), Eigen::VectorXd::Zero(3 * count),
                   log_power};
  for (const Look& look : looks) {
    const Probabilities is(look, log_power, options.metal_share);
    prior.metal_share += (1 - is.of_dielectric) / static_cast<double>(count);
  }
  const Eigen::Matrix3d chroma = Eigen::Matrix3d::Identity() - Eigen::Matrix3d::Constant(1.0 / 3);
  const auto slope = [&](Eigen::Index k) {  // of the logarithm by each channel
    return 1 / (3 * (looks[static_cast<size_t>(k)].grey + kBlackSpecular));
  };
  for (Eigen::Index k = 0; k < count; ++k) {
    for (Eigen::Index l = 0; l < count; ++l) {
      prior.information.block<3, 3>(3 * k, 3 * l).setConstant(slope(k) * slope(l) * joint(k, l));
    }
    prior.information.block<3, 3>(3 * k, 3 * k) += by_chroma[k] * chroma;
    prior.gradient.segment<3>(3 * k).setConstant(slope(k) * pull[k]);
    prior.gradient.segment<3>(3 * k) -= by_chroma[k] * (chroma * means[static_cast<size_t>(k)]);
  }
  return prior;
}

}  // namespace glint
