/// \file What the experimenter's own window shows and asks for.
///
/// How a session gets that window, beside the participant's:
///
///     TerminalExperimenter terminal(standard_terminal());
///     ConsoleExperimenter console(terminal);  // the session's Experimenter from now on
///     ParticipantWindowOptions options;
///     options.console = &console;
///     options.console_monitor = 2;  // or leave it: wherever the system puts a window
///     ParticipantWindow window(options);
///
/// Day sheet, consent to force and spoken answers stay at the terminal: the terminal goes on being
/// the session's Attendant and SpokenEntry.
#pragma once

#include "protocols/session/experimenter.hpp"

#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {

/// Passes everything on to another experimenter, and has room for a window's requests beside. Never
/// knows what is presented, nor whether an answer was right.
class ConsoleExperimenter final : public session::Experimenter {
 public:
  /// \param inner  must outlive this
  explicit ConsoleExperimenter(session::Experimenter& inner) : inner_(inner) {}

  /// \name The session's thread
  ///@{
  void show(const session::SessionStatus& status) override;
  /// What the window asked for first, then the inner one's.
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
  /// As it was shown last.
  [[nodiscard]] session::SessionStatus status() const;
  /// Called whenever the status reads otherwise than before; null: nobody is. Must call nothing of
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
