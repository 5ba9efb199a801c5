/// \file What `sync` says when it is done.
#pragma once

#include "protocols/collect/enrolment_balance.hpp"
#include "protocols/collect/station_push.hpp"

#include <string>
#include <vector>

namespace touchtrial::app {

struct StationSummary {
  std::string file;
  collect::PushReport report;
};

struct SyncSummary {
  std::string server;  ///< without user
  bool dry_run = false;
  std::vector<StationSummary> stations{};
  collect::EnrolmentBalance balance{};  ///< of everything on the server
  std::string balance_unknown{};        ///< why it could not be asked; empty: it could
};

[[nodiscard]] std::string sync_text(const SyncSummary& summary);
/// One JSON object.
[[nodiscard]] std::string sync_json(const SyncSummary& summary);

}  // namespace touchtrial::app
