/// \file One session of a study, from the options of `touchtrial run` to its end.
#pragma once

#include "app/commands/heads.hpp"
#include "app/windows/participant/participant_window.hpp"
#include "study/study.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

namespace touchtrial::app {

/// What to do with an existing session of the participant.
enum class OnExisting { refuse, resume, restart };

/// The options of `touchtrial run`.
struct RunOptions {
  std::filesystem::path study;
  std::string participant;  ///< empty: ask the experimenter
  std::string remark;       ///< about the participant; recorded as a note
  bool no_consent = false;  ///< whether the dialogue recorded no consent
  std::filesystem::path database;
  std::filesystem::path pack;          ///< empty: the default of `prepare`
  std::filesystem::path station_file;  ///< empty: beside the pack
  std::string device;                  ///< driver; empty: the connected one
  std::filesystem::path settings;
  std::filesystem::path certificate;  ///< empty: NAME-certificate.json
  bool allow_unverified = false;      ///< run a force-feedback device without a valid certificate
  bool allow_late = false;            ///< run a force-feedback device without real-time scheduling
  bool pilot = false;
  OnExisting on_existing = OnExisting::refuse;
  HeadOptions heads;
  int enrolment = 0;           ///< 0: the station's next number
  int visit = 1;               ///< number of the participant's visit
  std::string accept_clock{};  ///< reason to accept a previous visit with a date in the future
  bool yes = false;            ///< do not ask about an unusual id or number
  std::string station{};       ///< its name; empty: the study's only station
  /// A simulated participant instead of a person: a model file, or "default".
  std::optional<std::filesystem::path> subject;
  std::string hand_device;  ///< the simulated hand's device model; empty: ideal
  std::uint64_t seed = 1;   ///< seed of the simulated participant
  bool real_time = false;   ///< run a simulated participant in real time
  bool console = false;     ///< open a window for the experimenter
  int console_monitor = 0;  ///< monitor of that window, from 1; 0: the system decides
  bool sound = true;
  int monitor = 1;                     ///< the participant's, from 1; full screen
  std::optional<double> text_scale{};  ///< text size for the participant; empty: the study's
  bool high_contrast = false;          ///< even if the study does not require it
  /// Width and height of the participant's window in pixels, instead of full screen.
  std::optional<std::pair<int, int>> window_px;

  [[nodiscard]] bool is_simulated() const noexcept { return subject.has_value(); }
};

/// The participant's window of a study, without a device and sounds.
/// \throws as read_grey_image, for the study's pictures
[[nodiscard]] ParticipantWindowOptions window_options(const RunOptions& options,
                                                      const study::Study& study);

/// Runs the session of a person with a device and a window, or of a simulated participant without a
/// window. A window belongs to the calling thread, which must be the program's main thread; the
/// session then runs on another thread.
/// \return the exit code: 0 if the session is complete, 1 if it was stopped or left open, 128 plus
///   the signal's number if a signal ended the program
/// \throws touchtrial::Error with the remedy, before the session is opened or when it cannot continue;
///   an open session stays open and can be resumed
[[nodiscard]] int run_study_session(const RunOptions& options);

}  // namespace touchtrial::app
