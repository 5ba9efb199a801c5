#include "app/experimenter/terminal_experimenter.hpp"

#include "app/experimenter/status_words.hpp"
#include "protocols/simulation/simulated_participant.hpp"
#include "support/catch.hpp"

#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

namespace touchtrial {
namespace {

using Kind = session::ExperimenterRequest::Kind;

/// Keys in, text out.
struct TypedTerminal {
  std::string keys;
  std::string written;
  bool rewrites = true;

  app::ExperimenterTerminal terminal() {
    app::ExperimenterTerminal terminal;
    terminal.key = [this]() -> std::optional<char> {
      if (keys.empty()) return std::nullopt;
      const char key = keys.front();
      keys.erase(0, 1);
      return key;
    };
    terminal.write = [this](const std::string& text) { written += text; };
    terminal.rewrites = rewrites;
    return terminal;
  }
};

session::SessionStatus exploring() {
  session::SessionStatus status;
  status.participant = "P07";
  status.stage = "exploring";
  status.trial = 3;
  status.of = 25;
  return status;
}

std::vector<session::ExperimenterRequest> all_requests(session::Experimenter& experimenter) {
  std::vector<session::ExperimenterRequest> requests;
  while (auto request = experimenter.request()) requests.push_back(*request);
  return requests;
}

TEST_CASE("pause and comfort stop act at their key, and the reason follows") {
  TypedTerminal typed;
  app::TerminalExperimenter experimenter(typed.terminal());
  typed.keys = "c";
  auto requests = all_requests(experimenter);
  REQUIRE(requests.size() == 1);
  CHECK(requests[0].kind == Kind::comfort_stop);
  typed.keys = "cramp\nptea\nr";
  requests = all_requests(experimenter);
  REQUIRE(requests.size() == 4);
  CHECK(requests[0].kind == Kind::deviation);
  CHECK(requests[0].code == "comfort-stop");
  CHECK(requests[0].text == "cramp");
  CHECK(requests[1].kind == Kind::pause);
  CHECK(requests[2].text == "pause: tea");
  CHECK(requests[3].kind == Kind::resume);
}

TEST_CASE("notes and deviations accept umlauts and backspace, and Escape discards them") {
  TypedTerminal typed;
  app::TerminalExperimenter experimenter(typed.terminal());
  typed.keys =
      "nlaut\xc3\xbc\x7f hier\nnnothing\x1b"
      "dno-curtain\nf\xc3\xbcr P07\nn\n";
  const auto requests = all_requests(experimenter);
  REQUIRE(requests.size() == 2);
  CHECK(requests[0].text == "laut hier");
  CHECK(requests[1].kind == Kind::deviation);
  CHECK(requests[1].code == "no-curtain");
  CHECK(requests[1].text == "f\xc3\xbcr P07");
}

TEST_CASE("Tab completes the code of a deviation, and goes on to the next of the program's") {
  TypedTerminal typed;
  app::TerminalExperimenter experimenter(typed.terminal());
  typed.keys = "dno-cu\t\nfell\ndno-ca\t\n\ndno-c\t\t\n\nd\t\n\ndmy own\t\n\n";
  const auto requests = all_requests(experimenter);
  REQUIRE(requests.size() == 5);
  CHECK(requests[0].code == "no-curtain");
  CHECK(requests[1].code == "no-calibration");
  CHECK(requests[2].code == "no-certificate");
  CHECK(requests[3].code == "answers-lost");
  CHECK(requests[4].code == "my own");
}

TEST_CASE("a session is ended only after yes and a reason") {
  TypedTerminal typed;
  app::TerminalExperimenter experimenter(typed.terminal());
  typed.keys = "ay\naunwell\n";
  CHECK(all_requests(experimenter).empty());
  typed.keys =
      "\x1b"
      "ayes\nunwell\n";
  const auto requests = all_requests(experimenter);
  REQUIRE(requests.size() == 1);
  CHECK(requests[0].kind == Kind::abort);
  CHECK(requests[0].text == "unwell");
}

TEST_CASE("the day sheet is ticked item by item, and one can go back") {
  TypedTerminal typed;
  app::TerminalExperimenter experimenter(typed.terminal());
  const std::vector<session::DaySheetItem> items{{"no-a", "A is there"}, {"no-b", "B is there"}};
  CHECK_FALSE(experimenter.day_sheet(items));
  CHECK(typed.written.find("1/2 A is there\n") != std::string::npos);
  typed.keys = "sb\n";
  CHECK_FALSE(experimenter.day_sheet(items));
  typed.keys = "s";
  CHECK(experimenter.day_sheet(items).value() ==
        std::vector<session::Tick>{session::Tick::done, session::Tick::skipped});
}

TEST_CASE("without a keyboard nobody is asked, and only progress is printed") {
  TypedTerminal typed;
  typed.rewrites = false;
  app::ExperimenterTerminal terminal = typed.terminal();
  terminal.key = nullptr;
  app::TerminalExperimenter experimenter(terminal);
  CHECK(experimenter.day_sheet({{"no-a", "A"}}).value().empty());
  session::SessionStatus status = exploring();
  experimenter.show(status);
  status.elapsed = std::chrono::seconds(1);
  experimenter.show(status);
  CHECK(typed.written == "P07  exploring  trial 3 of 25  0:00\n");
  status.stage = "answering";
  experimenter.show(status);
  CHECK(typed.written.find("answering  trial 3 of 25  0:01\n") != std::string::npos);
}

TEST_CASE("the status line is overwritten and never wraps") {
  TypedTerminal typed;
  app::TerminalExperimenter experimenter(typed.terminal());
  typed.written.clear();
  session::SessionStatus status = exploring();
  status.device = std::string(100, 'd');
  experimenter.show(status);
  CHECK(typed.written.find('\n') == std::string::npos);
  CHECK(typed.written.front() == '\r');
  CHECK(typed.written.size() == 1 + 79 + 3);
  CHECK(app::first_of("\xc3\xa4\xc3\xb6\xc3\xbc", 2) == "\xc3\xa4\xc3\xb6");
  CHECK(app::last_of("\xc3\xa4\xc3\xb6\xc3\xbc", 2) == "\xc3\xb6\xc3\xbc");
}

TEST_CASE("the participant's stop is told once and audibly, with what to do") {
  TypedTerminal typed;
  app::TerminalExperimenter experimenter(typed.terminal());
  session::SessionStatus status = exploring();
  experimenter.show(status);
  typed.written.clear();
  status.stage = "stopped";
  status.participant_stopped = true;
  status.needs_consent = true;
  experimenter.show(status);
  experimenter.show(status);
  const std::string told = "The participant has stopped the force.";
  const std::size_t at = typed.written.find(told);
  REQUIRE(at != std::string::npos);
  CHECK(typed.written.find(told, at + 1) == std::string::npos);
  CHECK(typed.written.find('\a') != std::string::npos);
  CHECK(typed.written.find("press g") != std::string::npos);
  CHECK(typed.written.find("stopped by the participant") != std::string::npos);
  status = exploring();
  experimenter.show(status);
  status.stage = "stopped";
  status.participant_stopped = true;
  experimenter.show(status);
  CHECK(typed.written.find(told, at + 1) != std::string::npos);
}

TEST_CASE("lines of standard output do not run into the line that is overwritten") {
  TypedTerminal typed;
  app::TerminalExperimenter experimenter(typed.terminal());
  experimenter.show(exploring());
  typed.written.clear();
  experimenter.acknowledged(3);
  CHECK(typed.written == "\r\x1b[K");
  experimenter.show(exploring());
  typed.written.clear();
  experimenter.end_line();
  CHECK(typed.written == "\n");
  experimenter.end_line();
  CHECK(typed.written == "\n");
}

TEST_CASE("force comes on only by a key that is pressed when nothing is missing") {
  TypedTerminal typed;
  app::TerminalExperimenter experimenter(typed.terminal());
  typed.keys = "g";
  CHECK(experimenter.attend("move the handle") == session::Attendant::Says::wait);
  CHECK(experimenter.attend("") == session::Attendant::Says::wait);
  // Meanwhile, the session takes requests and shows its status.
  typed.keys = "g";
  CHECK_FALSE(experimenter.request());
  experimenter.show(exploring());
  CHECK(experimenter.attend("") == session::Attendant::Says::arm);
  CHECK(experimenter.attend("") == session::Attendant::Says::wait);
  typed.keys = "g";
  CHECK_FALSE(experimenter.request());
  CHECK(experimenter.attend("put it into the inkwell") == session::Attendant::Says::wait);
  CHECK(experimenter.attend("") == session::Attendant::Says::wait);
  typed.keys = "ayes\nfire alarm\n";
  CHECK(experimenter.attend("") == session::Attendant::Says::stop);
  CHECK(all_requests(experimenter).at(0).text == "fire alarm");
}

TEST_CASE("the arm is at its reset position by a key that is pressed when the line asks for it") {
  TypedTerminal typed;
  app::TerminalExperimenter experimenter(typed.terminal());
  typed.keys = "h";
  CHECK_FALSE(experimenter.request());
  CHECK(experimenter.attend("put the arm at its place") == session::Attendant::Says::wait);
  typed.keys = "h";
  CHECK(experimenter.attend("put the arm at its place") == session::Attendant::Says::at_reset);
  CHECK(experimenter.attend("put the arm at its place") == session::Attendant::Says::wait);
  typed.keys = "h";
  CHECK(experimenter.attend("") == session::Attendant::Says::wait);
}

TEST_CASE("the line says how the hand presses and strokes while it is at the plane") {
  session::SessionStatus status = exploring();
  status.rate_hz = 1000.0;
  CHECK_THAT(app::status_line(status), holds_text("1000/s") && !holds_text("force"));
  status.hand = session::HandLevels{session::HandLevel::low, session::HandLevel::high};
  CHECK_THAT(app::status_line(status),
             holds_text("force low  speed high") && !holds_text("1000/s"));
}

TEST_CASE("requests from other sources come after the typed ones") {
  TypedTerminal typed;
  app::TerminalExperimenter experimenter(typed.terminal());
  experimenter.add({Kind::note, "noise", ""});
  typed.keys = "r";
  const auto requests = all_requests(experimenter);
  REQUIRE(requests.size() == 2);
  CHECK(requests[0].kind == Kind::resume);
  CHECK(requests[1].text == "noise");
}

class Blindfolded final : public simulation::PromptParticipant {
 public:
  void see_pictures(const std::vector<std::string>&) override {}
  [[nodiscard]] device::HapticDevice& begin_exploring(const PlaneGeometry&) override {
    throw std::logic_error("nobody explores");
  }
  void feel(const device::ServoSample&) noexcept override {}
  [[nodiscard]] simulation::ParticipantAnswer answer() override { return {2, {}}; }
};

TEST_CASE("a spoken answer is entered by its number in alphabetical order") {
  TypedTerminal typed;
  app::TerminalExperimenter experimenter(typed.terminal());
  Blindfolded participant;
  app::SpokenAnswers spoken(participant, experimenter);
  spoken.see_pictures({"sand", "bark", "cloth"});
  session::AnswerStep step;
  step.trial = 7;
  step.sight = design::Sight::blindfold;
  step.confidence_levels = 5;
  CHECK_FALSE(spoken.attend(step));
  CHECK(typed.written.find("trial 7: 1 bark 2 cloth 3 sand: ") != std::string::npos);
  typed.keys = "9\n1\n3\n2\n";
  CHECK_FALSE(spoken.attend(step));
  CHECK(typed.written.find("sand; Enter confirms: ") != std::string::npos);
  // Keys that are read while the session takes requests still belong to the answer.
  typed.keys = "\n6\n4";
  CHECK_FALSE(experimenter.request());
  typed.keys = "\n";
  const auto reply = spoken.attend(step);
  REQUIRE(reply);
  CHECK(reply->position == 0);
  CHECK(reply->first_position == 1);
  CHECK(reply->confidence == 4);
  CHECK(reply->at);
}

TEST_CASE("an unfinished entry is discarded at the next exploration") {
  TypedTerminal typed;
  app::TerminalExperimenter experimenter(typed.terminal());
  Blindfolded participant;
  app::SpokenAnswers spoken(participant, experimenter);
  spoken.see_pictures({"sand", "bark", "cloth"});
  session::AnswerStep step;
  step.sight = design::Sight::blindfold;
  typed.keys = "3\n";
  CHECK_FALSE(spoken.attend(step));
  CHECK_FALSE(spoken.attend(step));
  CHECK_THROWS_AS(spoken.begin_exploring(PlaneGeometry{}), std::logic_error);
  typed.keys = "\n";
  CHECK_FALSE(spoken.attend(step));
  CHECK_FALSE(spoken.attend(step));
}

TEST_CASE("participants who see answer for themselves") {
  TypedTerminal typed;
  app::TerminalExperimenter experimenter(typed.terminal());
  Blindfolded participant;
  app::SpokenAnswers spoken(participant, experimenter);
  spoken.see_pictures({"sand", "bark", "cloth"});
  const auto reply = spoken.attend(session::AnswerStep{});
  REQUIRE(reply);
  CHECK(reply->position == 2);
}

}  // namespace
}  // namespace touchtrial
