#include "app/sync_summary.hpp"

#include <fmt/format.h>

namespace touchtrial::app {
namespace {

std::string participants(const std::vector<collect::PushedSession>& sessions) {
  std::string names;
  for (const collect::PushedSession& session : sessions) {
    names += (names.empty() ? "" : ", ") + session.participant;
  }
  return names;
}

std::string counted(std::size_t count) {
  return count == 1 ? "1 session" : fmt::format("{} sessions", count);
}

std::string station_text(const StationSummary& summary, bool dry_run) {
  const collect::PushReport& report = summary.report;
  std::string text =
      fmt::format("{}: {} {}, {} there before", summary.file, counted(report.pushed.size()),
                  dry_run ? "to push" : "pushed", report.already_there);
  if (report.station > 0) text += fmt::format(" (station {})", report.station);
  text += "\n";
  if (!report.left_open.empty()) {
    text += fmt::format("{}: {} not finished, left for later: {}\n", summary.file,
                        counted(report.left_open.size()), participants(report.left_open));
  }
  if (!report.cut_short.empty()) {
    text += fmt::format(
        "{}: {} replaced or withdrawn before the end, which cannot go on and {} not pushed: {}\n",
        summary.file, counted(report.cut_short.size()), report.cut_short.size() == 1 ? "is" : "are",
        participants(report.cut_short));
  }
  if (report.ahead > 0) {
    text += fmt::format(
        "{}: is an older copy: the server has {} more of its file chain's events; do not go on "
        "recording in it\n",
        summary.file, report.ahead);
  }
  if (report.keys_restored > 0) {
    text += fmt::format("{}: brought back {} key{} that somebody had deleted or changed there\n",
                        summary.file, report.keys_restored, report.keys_restored == 1 ? "" : "s");
  }
  if (report.reconnections > 0) {
    text += fmt::format("{}: lost the connection, {} attempt{} to connect anew\n", summary.file,
                        report.reconnections, report.reconnections == 1 ? "" : "s");
  }
  return text;
}

}  // namespace

std::string sync_text(const SyncSummary& summary) {
  std::string text =
      summary.server + (summary.dry_run ? " (dry run: nothing was changed)\n" : "\n");
  for (const StationSummary& station : summary.stations) {
    text += station_text(station, summary.dry_run);
  }
  if (!summary.balance_unknown.empty()) {
    return text + "balance: could not be asked (" + summary.balance_unknown + ")\n";
  }
  for (const std::string& line : collect::imbalances(summary.balance))
    text += "imbalance: " + line + "\n";
  return text;
}

}  // namespace touchtrial::app
