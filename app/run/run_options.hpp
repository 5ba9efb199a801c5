/// \file The options of `touchtrial run`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

namespace touchtrial::app {

/// What happens with a session that the participant already has.
enum class OnExisting { refuse, resume, restart };

struct RunOptions {
  std::filesystem::path study;
  std::string participant;
  std::filesystem::path database;
  std::filesystem::path pack;  ///< empty: where `prepare` puts it
  std::filesystem::path key;   ///< empty: beside the pack
  std::string device;          ///< driver; empty: the simulated device for a subject
  std::filesystem::path settings;
  std::filesystem::path certificate;  ///< empty: NAME-certificate.json, if it exists
  bool pilot = false;
  OnExisting on_existing = OnExisting::refuse;
  int enrolment = 0;             ///< 0: the smallest free number, or the station's next number
  std::string station{};         ///< whose numbers of the plan are used; empty: no station's
  std::filesystem::path plan{};  ///< empty: where `plan` puts it
  /// A simulated participant instead of a person: a model file, or "default".
  std::optional<std::filesystem::path> subject;
  std::uint64_t seed = 1;  ///< of the simulated participant
  bool headless = false;
  bool real_time = false;   ///< run a simulated participant in real time
  bool console = false;     ///< open a window for the experimenter
  int console_monitor = 0;  ///< monitor of that window, from 1; 0: the system decides
  bool sound = true;
  int monitor = 1;  ///< the participant's, from 1; full screen
  /// Width and height of the participant's window in pixels, instead of full screen.
  std::optional<std::pair<int, int>> window_px;

  [[nodiscard]] bool is_simulated() const noexcept { return subject.has_value(); }
};

}  // namespace touchtrial::app
