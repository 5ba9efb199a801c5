/// \file The experimenter at a terminal: a status line, keys, and consent to force.
#pragma once

#include "app/experimenter/typing.hpp"
#include "protocols/session/device_station.hpp"
#include "protocols/session/experimenter.hpp"

#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {

/// The terminal of an experimenter.
struct ExperimenterTerminal {
  /// The next key, if one was pressed; never waits. Null if nobody types; then no questions are
  /// asked.
  std::function<std::optional<char>()> key;
  std::function<void(const std::string&)> write;
  /// Whether a line can be overwritten; else every change is a line of its own.
  bool rewrites = false;
  int columns = 80;
  /// Pauses between two calls that wait for a person. Null, as in tests: no pause.
  std::function<void()> pause;
};

/// Standard input and standard error. Keys are read one by one while a copy of it lives.
[[nodiscard]] ExperimenterTerminal standard_terminal();

/// Never shows what is presented, nor whether an answer was right. All functions except `add`
/// belong to the session's thread.
class TerminalExperimenter final : public session::Experimenter,
                                   public session::Attendant,
                                   public SpokenEntry {
 public:
  explicit TerminalExperimenter(ExperimenterTerminal terminal);
  /// Ends the line.
  ~TerminalExperimenter() override;
  TerminalExperimenter(const TerminalExperimenter&) = delete;
  TerminalExperimenter& operator=(const TerminalExperimenter&) = delete;

  /// Adds a request from another source, such as a window or the sound. May be called from any
  /// thread.
  void add(const session::ExperimenterRequest& request);

  void show(const session::SessionStatus& status) override;
  /// Makes room for a line of standard output.
  void acknowledged(int trial) override;
  /// Ends the line that is overwritten, before other output follows.
  void end_line();
  [[nodiscard]] std::optional<session::ExperimenterRequest> request() override;
  /// Returns an empty list at once if nobody types.
  [[nodiscard]] std::optional<std::vector<session::Tick>> day_sheet(
      const std::vector<session::DaySheetItem>& items) override;
  /// Key g arms and h says that the arm is at its reset position, if it is pressed after the line
  /// that says so; a stops after a question.
  [[nodiscard]] Says attend(const std::string& need) override;
  [[nodiscard]] std::optional<SpokenAnswer> spoken_answer(
      const session::AnswerStep& step, const std::vector<std::string>& labels) override;
  void forget_spoken_answer() override;

 private:
  void take_keys();
  /// Passes a key to the line that is being typed, the day sheet or a spoken answer.
  void take(char key);
  /// The content of the line: a question, else the status.
  [[nodiscard]] std::string line_now() const;
  void rewrite(const std::string& line);
  void show_item(const std::string& text);
  /// Says once, and audibly, that the participant has stopped the force, and what to do.
  void tell_stop(const session::SessionStatus& status);
  /// \param is_ready  nothing is missing
  [[nodiscard]] Says said(bool is_ready);
  void write_line(const std::string& line);

  ExperimenterTerminal terminal_;
  RequestTyping typing_;
  std::optional<TickList> sheet_;
  std::optional<AnswerTyping> spoken_;
  bool is_ready_shown_ = false;  ///< the line asks for the key that switches the force on
  bool arm_asked_ = false;
  bool at_reset_ = false;  ///< the arm is where the line asks for it
  std::string need_;       ///< what the device waits for, while it waits
  std::string status_;
  std::string item_;  ///< the item of the day sheet that was shown last
  std::string shown_;
  std::string progress_;
  bool is_stop_told_ = false;
  std::mutex mutex_;
  std::vector<session::ExperimenterRequest> added_;
};

}  // namespace touchtrial::app
