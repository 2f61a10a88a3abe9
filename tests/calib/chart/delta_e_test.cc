#include "calib/chart/delta_e.h"

#include <gtest/gtest.h>

#include "calib/chart/cielab.h"

namespace glint {
namespace {

struct Pair {
  Eigen::Vector3d first, second;
  double delta_e;
};

// G. Sharma, W. Wu, E. Dalal 2005, table 1.
std::vector<Pair> PublishedPairs() {
  return {{{50, 2.6772, -79.7751}, {50, 0, -82.7485}, 2.0425},
          {{50, 3.1571, -77.2803}, {50, 0, -82.7485}, 2.8615},
          {{50, 2.8361, -74.0200}, {50, 0, -82.7485}, 3.4412},
          {{50, -1.3802, -84.2814}, {50, 0, -82.7485}, 1.0000},
          {{50, -1.1848, -84.8006}, {50, 0, -82.7485}, 1.0000},
          {{50, -0.9009, -85.5211}, {50, 0, -82.7485}, 1.0000},
          {{50, 0, 0}, {50, -1, 2}, 2.3669},
          {{50, -1, 2}, {50, 0, 0}, 2.3669},
          {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0009}, 7.1792},
          {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0010}, 7.1792},
          {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0011}, 7.2195},
          {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0012}, 7.2195},
          {{50, -0.0010, 2.4900}, {50, 0.0009, -2.4900}, 4.8045},
          {{50, -0.0010, 2.4900}, {50, 0.0010, -2.4900}, 4.8045},
          {{50, -0.0010, 2.4900}, {50, 0.0011, -2.4900}, 4.7461},
          {{50, 2.5, 0}, {50, 0, -2.5}, 4.3065},
          {{50, 2.5, 0}, {73, 25, -18}, 27.1492},
          {{50, 2.5, 0}, {61, -5, 29}, 22.8977},
          {{50, 2.5, 0}, {56, -27, -3}, 31.9030},
          {{50, 2.5, 0}, {58, 24, 15}, 19.4535},
          {{50, 2.5, 0}, {50, 3.1736, 0.5854}, 1.0000},
          {{50, 2.5, 0}, {50, 3.2972, 0}, 1.0000},
          {{50, 2.5, 0}, {50, 1.8634, 0.5757}, 1.0000},
          {{50, 2.5, 0}, {50, 3.2592, 0.3350}, 1.0000},
          {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
          {{63.0109, -31.0961, -5.8663}, {62.8187, -29.7946, -4.0864}, 1.2630},
          {{61.2901, 3.7196, -5.3901}, {61.4292, 2.2480, -4.9620}, 1.8731},
          {{35.0831, -44.1164, 3.7933}, {35.0232, -40.0716, 1.5901}, 1.8645},
          {{22.7233, 20.0904, -46.6940}, {23.0331, 14.9730, -42.5619}, 2.0373},
          {{36.4612, 47.8580, 18.3852}, {36.2715, 50.5065, 21.2231}, 1.4146},
          {{90.8027, -2.0831, 1.4410}, {91.1528, -1.6435, 0.0447}, 1.4441},
          {{90.9257, -0.5406, -0.9208}, {88.6381, -0.8985, -0.7239}, 1.5381},
          {{6.7747, -0.2908, -2.4247}, {5.8714, -0.0985, -2.2286}, 0.6377},
          {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082}};
}

TEST(DeltaE00, IsThatOfThePublishedPairsInBothOrders) {
  for (const Pair& pair : PublishedPairs()) {
    EXPECT_NEAR(DeltaE00(pair.first, pair.second), pair.delta_e, 5e-5)
        << pair.first.transpose() << " | " << pair.second.transpose();
    EXPECT_NEAR(DeltaE00(pair.second, pair.first), pair.delta_e, 5e-5);
  }
}

TEST(DeltaE00, HasAMetricThatHoldsForSmallDifferences) {
  for (const Eigen::Vector3d& reference :
       {Eigen::Vector3d(50, 0, 0), Eigen::Vector3d(28.8, 14.2, -50.3),
        Eigen::Vector3d(42.1, 53.4, 28.2), Eigen::Vector3d(55.3, -38.3, 31.4),
        Eigen::Vector3d(81.7, 4, 79.8), Eigen::Vector3d(96.5, -0.4, 1.2)}) {
    const Eigen::Matrix3d metric = DeltaE00Metric(reference);
    for (const Eigen::Vector3d& off :
         {Eigen::Vector3d(0.3, 0, 0), Eigen::Vector3d(0, 0.3, 0), Eigen::Vector3d(0, 0, 0.3),
          Eigen::Vector3d(0.2, -0.2, 0.2), Eigen::Vector3d(-0.2, 0.2, 0.2)}) {
      const double exact = DeltaE00(reference + off, reference);
      EXPECT_NEAR((metric * off).norm() / exact, 1, 0.08)
          << reference.transpose() << " | " << off.transpose();
    }
  }
}

TEST(CieLab, WhiteIsWhiteAndColoursComeBack) {
  EXPECT_LT((Rec709FromLab({100, 0, 0}) - Eigen::Vector3d::Ones()).norm(), 1e-9);
  for (const Eigen::Vector3d& lab : {Eigen::Vector3d(40, 10, -46), Eigen::Vector3d(3, -1, 1),
                                     Eigen::Vector3d(51, -28.6, -28.6)}) {
    EXPECT_LT((LabFromRec709(Rec709FromLab(lab)) - lab).norm(), 1e-9);
  }
  // sRGB's red under D50, as colour managers give it.
  const Eigen::Vector3d red = LabFromRec709(Eigen::Vector3d(1, 0, 0));
  EXPECT_NEAR(red[0], 54.29, 0.02);
  EXPECT_NEAR(red[1], 80.81, 0.03);
  EXPECT_NEAR(red[2], 69.89, 0.03);
}

TEST(CieLab, AdaptsOneWhiteToAnother) {
  const Eigen::Vector3d a = *WhitePoint("A"), d50 = *WhitePoint("D50");
  EXPECT_LT((AdaptedXyz(0.5 * a, a, d50) - 0.5 * d50).norm(), 1e-12);
  EXPECT_FALSE(WhitePoint("F2"));
}

}  // namespace
}  // namespace glint
