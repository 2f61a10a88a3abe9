// Table 1 of Gao et al. 2019 ("DIR") on other materials: errors of maps and novel renderings by
// number of views and method, from running the programs.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "datasets/evaluation/map_error.h"
#include "datasets/synth/view_set.h"
#include "pipeline/contract/json.h"
#include "pipeline/contract/program.h"

namespace glint {

struct Table1Options {
  std::vector<std::string> materials;  // as LoadMaterial takes them
  std::vector<int> counts{1, 2, 5, 20};
  // classic: glint-fit --method classic; latent: glint-fit --method latent; refined: glint-refine
  // on the latent result.
  std::vector<std::string> methods{"classic", "latent", "refined"};
  std::filesystem::path work;  // WORK/MATERIAL/n05/{classic,latent}/ are captures; logs beside them
  int size = 256;
  ViewSetOptions views;                                      // its count is replaced
  std::vector<std::string> fit_arguments, refine_arguments;  // passed on
};

struct Table1Entry {
  std::string material;
  int count = 0;
  std::string method;
  Table1Row errors;
};

struct Table1 {
  std::vector<Table1Entry> entries;
  // One entry for each count and method, averaged over materials (material: "mean").
  std::vector<Table1Entry> Means() const;
  std::string Text() const;  // the means, aligned, as Markdown
  std::string Csv() const;   // all entries and the means
  Json ToJson() const;
};

// Resumable: each finished result is kept in WORK and not computed again as long as its settings
// are the same. `said` is told of each step. Throws what the programs ended with.
Table1 RunTable1(const Table1Options& options, const CommonOptions& common,
                 const std::function<void(const std::string&)>& said);

}  // namespace glint
