// A running Studio of a folder of its own, with a board.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "pipeline/studio/studio.h"
#include "tests/studio/http_client.h"
#include "tests/studio/picture.h"
#include "tests/support/process.h"

namespace glint::test {

struct RunningStudio {
  explicit RunningStudio(StudioOptions options = {}) {
    options.folder = folder.path();
    options.port = 0;
    options.check_threads = 1;
    options.lan_addresses = {"127.0.0.1"};
    options.version = "test";
    studio = std::make_unique<Studio>(options);
    page = std::make_unique<PageClient>(studio->address());
  }

  // A capture with the board that Studio prints; its id.
  std::string MakeCapture(const std::string& name = "wood") const {
    const Json board =
        page->Post("/api/boards", {{"paper", "A4"}, {"window_mm", {100, 100}}}).json();
    const Json made = page->Post("/api/captures", {{"name", name},
                                                   {"kind", "board"},
                                                   {"size_mm", {100, 100}},
                                                   {"height_mm", "auto"},
                                                   {"board", board["id"]}})
                          .json();
    return made.value("id", "");
  }

  Json Capture(const std::string& id) const { return page->Get("/api/captures/" + id).json(); }

  // Until no photograph waits for its check. A bad one is left out a moment after it is known to
  // be bad, unless a person has decided about it.
  Json CheckedCapture(const std::string& id) const {
    int moments = 0;
    for (int i = 0; i < 1000; ++i) {
      const Json capture = Capture(id);
      bool done = true, left_out = true;
      for (const Json& photo : capture["photographs"]) {
        done &= photo["state"] != "waiting" && photo["state"] != "checking";
        left_out &= photo["state"] != "bad" || photo["left_out"].get<bool>();
      }
      constexpr int kMoments = 25;
      if (done && (left_out || ++moments == kMoments)) return capture;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return Capture(id);
  }

  TemporaryFolder folder;
  std::unique_ptr<Studio> studio;
  std::unique_ptr<PageClient> page;
};

}  // namespace glint::test
