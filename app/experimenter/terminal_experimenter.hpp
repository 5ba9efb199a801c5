/// \file The experimenter at a terminal: a status line, keys, and consent to force.
#pragma once

#include "app/experimenter/answer_typing.hpp"
#include "app/experimenter/request_typing.hpp"
#include "app/experimenter/spoken_answers.hpp"
#include "app/experimenter/tick_list.hpp"
#include "protocols/session/device_station.hpp"
#include "protocols/session/experimenter.hpp"

#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {

/// What a terminal is to the experimenter's side of a session.
struct ExperimenterTerminal {
  /// The next key, if one was pressed; never waits. Nothing: nobody types, and nobody is asked.
  std::function<std::optional<char>()> key;
  std::function<void(const std::string&)> write;
  /// A line can be written over; else every change is a line of its own.
  bool rewrites = false;
  int columns = 80;
  /// Between two calls that wait for somebody. Null: no pause, as tests want it.
  std::function<void()> pause;
};

/// Standard input and standard error. Its keys are taken one by one as long as a copy of it lives.
[[nodiscard]] ExperimenterTerminal standard_terminal();

/// Never shows what is presented, nor whether an answer was right. All functions but `add` belong
/// to the session's thread.
class TerminalExperimenter final : public session::Experimenter,
                                   public session::Attendant,
                                   public SpokenEntry {
 public:
  explicit TerminalExperimenter(ExperimenterTerminal terminal);
  /// Ends the line.
  ~TerminalExperimenter() override;
  TerminalExperimenter(const TerminalExperimenter&) = delete;
  TerminalExperimenter& operator=(const TerminalExperimenter&) = delete;

  /// A request that something else makes: another window, the sound. Any thread.
  void add(const session::ExperimenterRequest& request);

  void show(const session::SessionStatus& status) override;
  [[nodiscard]] std::optional<session::ExperimenterRequest> request() override;
  /// At once and empty if nobody types.
  [[nodiscard]] std::optional<std::vector<session::Tick>> day_sheet(
      const std::vector<session::DaySheetItem>& items) override;
  /// Key g arms, if it comes after the line that says so; a, after a question, stops.
  [[nodiscard]] Says attend(const std::string& need) override;
  [[nodiscard]] std::optional<SpokenAnswer> spoken_answer(
      const session::AnswerStep& step, const std::vector<std::string>& labels) override;
  void forget_spoken_answer() override;

 private:
  void take_keys();
  /// To whatever the key is for: a line that is being typed, the day sheet, a spoken answer.
  void take(char key);
  /// What stands in the line: a question, else the status.
  [[nodiscard]] std::string line_now() const;
  void rewrite(const std::string& line);
  void show_item(const std::string& text);
  /// \param is_ready  nothing is missing
  [[nodiscard]] Says said(bool is_ready);
  void write_line(const std::string& line);

  ExperimenterTerminal terminal_;
  RequestTyping typing_;
  std::optional<TickList> sheet_;
  std::optional<AnswerTyping> spoken_;
  bool is_ready_shown_ = false;  ///< the line asks for the key that lets the force on
  bool arm_asked_ = false;
  std::string need_;  ///< what the line says meanwhile
  std::string status_;
  std::string item_;  ///< of the day sheet, shown last
  std::string shown_;
  std::string progress_;
  std::mutex mutex_;
  std::vector<session::ExperimenterRequest> added_;
};

}  // namespace touchtrial::app
