/// \file What `touchtrial run` was asked for.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

namespace touchtrial::app {

/// What is done with a session that the participant has already.
enum class OnExisting { refuse, resume, restart };

struct RunOptions {
  std::filesystem::path study;
  std::string participant;
  std::filesystem::path database;
  std::filesystem::path pack;  ///< empty: as `prepare` lays it
  std::filesystem::path key;   ///< empty: beside the pack
  std::string device;          ///< driver; empty: the simulated one for a subject
  std::filesystem::path settings;
  std::filesystem::path certificate;  ///< empty: NAME-certificate.json, if it is there
  bool pilot = false;
  OnExisting on_existing = OnExisting::refuse;
  int enrolment = 0;             ///< 0: the smallest that is free, or the station's next
  std::string station{};         ///< whose numbers of the plan are taken; empty: none's
  std::filesystem::path plan{};  ///< empty: as `plan` lays it
  /// A simulated participant instead of a person: a model file, or "default".
  std::optional<std::filesystem::path> subject;
  std::uint64_t seed = 1;  ///< of the simulated participant
  bool headless = false;
  bool real_time = false;   ///< a simulated participant in real time
  bool console = false;     ///< a window for the experimenter
  int console_monitor = 0;  ///< on which, from 1; 0: wherever the system puts it
  bool sound = true;
  int monitor = 1;  ///< the participant's, from 1; full screen
  /// Width and height of the participant's window instead, pixels.
  std::optional<std::pair<int, int>> window_px;

  [[nodiscard]] bool is_simulated() const noexcept { return subject.has_value(); }
};

}  // namespace touchtrial::app
