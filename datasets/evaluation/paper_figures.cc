#include "datasets/evaluation/paper_figures.h"

namespace glint {
namespace {

struct Row {
  int count;
  const char* method;
  Table1Row errors;
};

constexpr Row kTable1[] = {{1, "classic", {{.016030, .02109, .08772, .003790}, .007594}},
                           {1, "latent", {{.014400, .02123, .07209, .004214}, .007443}},
                           {1, "refined", {{.014440, .02121, .07145, .004235}, .007394}},
                           {2, "classic", {{.009133, .01818, .07673, .003293}, .006141}},
                           {2, "latent", {{.006029, .01725, .06269, .002284}, .004717}},
                           {2, "refined", {{.005919, .01722, .06235, .002079}, .004369}},
                           {5, "classic", {{.006182, .01485, .06686, .001340}, .002163}},
                           {5, "latent", {{.003349, .009078, .05515, .001042}, .002503}},
                           {5, "refined", {{.002854, .00817, .05548, .000489}, .001437}},
                           {20, "classic", {{.003658, .00724, .05278, .001198}, .001092}},
                           {20, "latent", {{.002098, .006228, .04249, .000715}, .001637}},
                           {20, "refined", {{.000850, .00447, .04130, .000273}, .000413}}};

struct Robustness {
  double light_off_deg, environment_percent;
  PaperFigures errors;
};

constexpr Robustness kTable2[] = {{0, 0, {.01172, .000413}}, {1, 0, {.01184, .000496}},
                                  {5, 0, {.01321, .001144}}, {10, 0, {.01575, .002654}},
                                  {0, 1, {.01181, .000481}}, {0, 5, {.01196, .000929}},
                                  {0, 10, {.01348, .002270}}};

}  // namespace

std::optional<Table1Row> PaperTable1(int count, const std::string& method) {
  for (const Row& row : kTable1) {
    if (row.count == count && row.method == method) return row.errors;
  }
  return std::nullopt;
}

std::optional<PaperFigures> PaperTable2(double light_off_deg, double environment_percent) {
  for (const Robustness& row : kTable2) {
    if (row.light_off_deg == light_off_deg && row.environment_percent == environment_percent) {
      return row.errors;
    }
  }
  return std::nullopt;
}

}  // namespace glint
