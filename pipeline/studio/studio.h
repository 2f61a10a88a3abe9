// Glint Studio: a folder of captures in a browser.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "pipeline/studio/http/deadline_socket.h"

namespace glint {

struct StudioOptions {
  std::filesystem::path folder = ".";
  int port = 8417;               // 0: any free one
  bool lan = false;              // other machines of the network may open Studio as well
  int check_threads = 0;         // 0: one for each core
  bool prepare_options = false;  // ask the programs for their options before a page does
  std::string version;
  std::vector<std::string> lan_addresses;  // of this machine; empty: as its interfaces say
  double phone_idle_s = 1800, phone_longest_s = 4 * 3600;  // see phone_links.h
  DeadlineOptions deadlines;
};

class Studio {
 public:
  // Serves from now on. Throws UserError: no such folder, or another Studio has it;
  // EnvironmentError: the port is taken.
  explicit Studio(const StudioOptions& options);
  ~Studio();  // cancels runs
  Studio(const Studio&) = delete;
  Studio& operator=(const Studio&) = delete;

  int port() const;
  std::string address() const;      // with the secret that lets a browser in
  std::string lan_address() const;  // of --lan; empty: there is none

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace glint
