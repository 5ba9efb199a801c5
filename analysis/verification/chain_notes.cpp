#include "analysis/verification/chain_notes.hpp"

#include "core/errors.hpp"
#include "core/utc.hpp"
#include "record/damage.hpp"
#include "record/payload_json.hpp"

#include <chrono>
#include <optional>
#include <span>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

using std::chrono::seconds;

constexpr seconds kIgnoredClockStep{1};

void add_clock_notes(std::vector<std::string>& notes, std::span<const record::Event> chain,
                     const std::string& name) {
  for (std::size_t i = 1; i < chain.size(); ++i) {
    const auto previous = chain[i - 1].at;
    const auto at = chain[i].at;
    // As floating point: damaged times may lie further apart than an integer holds.
    const double back_s =
        std::chrono::duration<double>(previous).count() - std::chrono::duration<double>(at).count();
    if (back_s <= static_cast<double>(kIgnoredClockStep.count())) continue;
    notes.push_back(
        fmt::format("{}, event {}: the clock was set back by {:.0f} s, from {} to {}; times around "
                    "it are uncertain",
                    name, chain[i].sequence, back_s, utc_text(previous), utc_text(at)));
  }
}

void add_head_file_moves(std::vector<std::string>& notes, std::span<const record::Event> chain,
                         const std::string& name) {
  std::optional<std::string> previous;
  for (const record::Event& event : chain) {
    if (event.kind != record::EventKind::heads_kept) continue;
    const std::string second_file = record::body_of<record::HeadsBody>(event).also;
    if (previous) {
      notes.push_back(one_line(fmt::format("{}, event {}: from here on the second head file is {}",
                                           name, event.sequence,
                                           second_file.empty() ? "dropped" : "in " + second_file)));
    }
    previous = second_file;
  }
}

void add_losses(std::vector<std::string>& notes, std::span<const record::Event> chain,
                const std::string& name) {
  for (const record::Event& event : chain) {
    if (event.kind != record::EventKind::loss_accepted) continue;
    const record::LossBody loss = record::body_of<record::LossBody>(event);
    notes.push_back(one_line(fmt::format("{}, event {}: a loss was accepted ({}): {}", name,
                                         event.sequence, loss.reason, loss.missing)));
  }
}

}  // namespace

std::vector<std::string> chain_notes(const record::StudyStore& store) {
  std::vector<std::string> notes;
  const bool has_clock = !store.commitment().simulated;
  const auto add = [&](std::span<const record::Event> chain, const std::string& name) {
    if (has_clock) add_clock_notes(notes, chain, name);
    add_losses(notes, chain, name);
    add_head_file_moves(notes, chain, name);
  };
  if (store.stations() == 0) add(store.events(0), "the file's chain");
  for (int station = 1; station <= store.stations(); ++station) {
    add(store.station_chain(station), fmt::format("station {}'s chain", station));
  }
  return notes;
}

}  // namespace touchtrial::analysis
