/// \file The experimenter's window as the session sees it: what it shows, and what it requests.
///
/// A session opens that window beside the participant's like this:
///
///     TerminalExperimenter terminal(standard_terminal());
///     ConsoleExperimenter console(terminal);  // the session's Experimenter from now on
///     ParticipantWindowOptions options;
///     options.console = &console;
///     options.console_monitor = 2;  // without it, the system chooses the place
///     ParticipantWindow window(options);
///
/// Day sheet, consent to force and spoken answers stay at the terminal, which remains the session's
/// Attendant and SpokenEntry.
#pragma once

#include "protocols/session/experimenter.hpp"

#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {

/// Forwards everything to another experimenter and adds the requests of a window. Never knows what
/// is presented, nor whether an answer was right.
class ConsoleExperimenter final : public session::Experimenter {
 public:
  /// \param inner  must outlive this
  explicit ConsoleExperimenter(session::Experimenter& inner) : inner_(inner) {}

  /// \name The session's thread
  ///@{
  void show(const session::SessionStatus& status) override;
  /// The window's requests first, then those of the inner experimenter.
  [[nodiscard]] std::optional<session::ExperimenterRequest> request() override;
  [[nodiscard]] std::optional<std::vector<session::Tick>> day_sheet(
      const std::vector<session::DaySheetItem>& items) override {
    return inner_.day_sheet(items);
  }
  void acknowledged(int trial) override { inner_.acknowledged(trial); }
  ///@}

  /// \name Any thread
  ///@{
  void add(const session::ExperimenterRequest& request);
  /// The status that was shown last.
  [[nodiscard]] session::SessionStatus status() const;
  /// Sets a function that is called whenever the status line changes; null: none. It must not call
  /// this object.
  void on_change(std::function<void()> listener);
  ///@}

 private:
  session::Experimenter& inner_;
  mutable std::mutex mutex_;
  session::SessionStatus status_;
  std::string words_;
  std::deque<session::ExperimenterRequest> added_;
  std::function<void()> listener_;
};

}  // namespace touchtrial::app
