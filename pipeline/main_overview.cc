// glint-overview: one page about many captures.
#include <fmt/format.h>

#include <algorithm>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/programs/program.h"
#include "pipeline/overview/overview_page.h"

namespace {

namespace fs = std::filesystem;
using namespace glint;

ProgramResult Write(const std::vector<std::string>& folders, const fs::path& page) {
  std::vector<CaptureSummary> captures;
  for (const std::string& folder : folders) captures.push_back(SummariseCapture(folder));
  WriteFileAtomically(page, OverviewPage(captures, page));
  Json list = Json::array();
  for (const CaptureSummary& capture : captures) list.push_back(ToJson(capture));
  const auto done = std::count_if(captures.begin(), captures.end(), [](const CaptureSummary& c) {
    return c.state == CaptureSummary::State::kDone;
  });
  return {fmt::format("overview: {} of {} captures done; page: {}", done, captures.size(),
                      page.string()),
          {{"page", page.string()}, {"captures", list}}};
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> folders;
  fs::path page = "overview.html";
  OptionSet options;
  options.AddPositional("CAPTURES", &folders, "folders of captures", true);
  options.Add("out", &page, "the page to write");
  return RunProgram(
      argc, argv,
      {"glint-overview",
       "Writes one page about many captures: what failed and why, the verdict on "
       "the photographs, key numbers, and a link to each capture's page.",
       GLINT_VERSION, "Example: glint overview captures/* --out captures.html", false},
      &options, [&](const CommonOptions&) { return Write(folders, page); });
}
