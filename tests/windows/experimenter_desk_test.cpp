#include "app/windows/experimenter/experimenter_desk.hpp"

#include "app/windows/experimenter/status_words.hpp"
#include "app/windows/experimenter/terminal_face.hpp"
#include "protocols/simulation/simulated_participant.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace touchtrial {
namespace {

using Kind = session::ExperimenterRequest::Kind;

/// A desk with a terminal: keys in, text out.
struct Terminal {
  explicit Terminal(bool has_rewrites = true, bool has_keys = true) : desk(has_keys) {
    app::ExperimenterTerminal terminal;
    terminal.key = [this]() -> std::optional<char> {
      if (keys.empty()) return std::nullopt;
      const char key = keys.front();
      keys.erase(0, 1);
      return key;
    };
    if (!has_keys) terminal.key = nullptr;
    terminal.write = [this](const std::string& text) { written += text; };
    terminal.can_rewrite = has_rewrites;
    face.emplace(desk, terminal);
    written.clear();
  }

  /// What the session is asked after these keys.
  std::vector<session::ExperimenterRequest> typed(const std::string& more) {
    keys += more;
    std::vector<session::ExperimenterRequest> requests;
    while (auto request = desk.request()) requests.push_back(*request);
    return requests;
  }

  std::string keys;
  std::string written;
  app::ExperimenterDesk desk;
  std::optional<app::TerminalFace> face;
};

session::SessionStatus exploring() {
  return {.participant = "P07", .stage = "exploring", .trial = 3, .total = 25};
}

bool is_same(const session::ExperimenterRequest& a, const session::ExperimenterRequest& b) {
  return a.kind == b.kind && a.text == b.text && a.code == b.code;
}

struct TypedRequests {
  const char* keys;
  std::vector<session::ExperimenterRequest> requests;
};

TEST_CASE("what is typed becomes requests") {
  const TypedRequests typed = GENERATE(values<TypedRequests>({
      {"c", {{Kind::comfort_stop, "", ""}}},
      {"ccramp\n", {{Kind::comfort_stop, "", ""}, {Kind::deviation, "cramp", "comfort-stop"}}},
      {"ptea\nr", {{Kind::pause, "", ""}, {Kind::note, "pause: tea", ""}, {Kind::resume, "", ""}}},
      {"p\nr", {{Kind::pause, "", ""}, {Kind::resume, "", ""}}},
      {"p\np", {{Kind::pause, "", ""}}},
      {"nlaut\xc3\xbc\x7f hier\n", {{Kind::note, "laut hier", ""}}},
      {"nnothing\x1bn\nrgh", {}},
      {"dno-curtain\nf\xc3\xbcr P07\n", {{Kind::deviation, "f\xc3\xbcr P07", "no-curtain"}}},
      {"dno-cu\t\nfell\n", {{Kind::deviation, "fell", "no-curtain"}}},
      {"dno-c\t\t\n\n", {{Kind::deviation, "", "no-certificate"}}},
      {"d\t\n\n", {{Kind::deviation, "", "answers-lost"}}},
      {"dmy own\t\n\n", {{Kind::deviation, "", "my own"}}},
      {"dno-cu\n\n", {}},
      {"dno-cu\nno-curtain\nfell\n", {{Kind::deviation, "fell", "no-curtain"}}},
      {"dno-curtain", {}},
      {"dno-curtain\nfel\x1b", {}},
      {"ay\naunwell\n\x1b", {}},
      {"ayes\nunwell\n", {{Kind::abort, "unwell", ""}}},
  }));
  CAPTURE(typed.keys);
  Terminal terminal;
  CHECK(std::ranges::equal(terminal.typed(typed.keys), typed.requests, is_same));
}

TEST_CASE("the day sheet is ticked item by item, and one can go back") {
  Terminal terminal;
  const std::vector<session::DaySheetItem> items{{"no-a", "A is there"}, {"no-b", "B is there"}};
  CHECK_FALSE(terminal.desk.day_sheet(items));
  CHECK_THAT(terminal.written, holds_text("1/2 A is there\n"));
  terminal.keys = "sb\n";
  CHECK_FALSE(terminal.desk.day_sheet(items));
  // The window's buttons answer the same question.
  CHECK(terminal.desk.view().question.text == "2/2 B is there");
  terminal.desk.answer(terminal.desk.view().question.choices.at(1).answer);
  CHECK(terminal.desk.day_sheet(items).value() ==
        std::vector<session::Tick>{session::Tick::done, session::Tick::skipped});
}

TEST_CASE("without a keyboard no question is asked, and only progress is printed") {
  Terminal terminal(false, false);
  CHECK(terminal.desk.day_sheet({{"no-a", "A"}}).value().empty());
  session::SessionStatus status = exploring();
  terminal.desk.show(status);
  status.elapsed = std::chrono::seconds(1);
  terminal.desk.show(status);
  CHECK(terminal.written == "P07  exploring  trial 3 of 25  0:00\n");
  status.stage = "answering";
  terminal.desk.show(status);
  CHECK_THAT(terminal.written, holds_text("answering  trial 3 of 25  0:01\n"));
}

TEST_CASE("the status line is overwritten and never wraps") {
  Terminal terminal;
  session::SessionStatus status = exploring();
  status.device = std::string(100, 'd');
  terminal.desk.show(status);
  CHECK(terminal.written.find('\n') == std::string::npos);
  CHECK(terminal.written.front() == '\r');
  CHECK(terminal.written.size() == 1 + 79 + 3);
  CHECK(app::first_characters("\xc3\xa4\xc3\xb6\xc3\xbc", 2) == "\xc3\xa4\xc3\xb6");
  CHECK(app::last_characters("\xc3\xa4\xc3\xb6\xc3\xbc", 2) == "\xc3\xb6\xc3\xbc");
}

TEST_CASE("the participant's stop is announced once with a sound, and advice") {
  Terminal terminal;
  session::SessionStatus stopped = exploring();
  stopped.stage = "stopped";
  stopped.participant_stopped = true;
  stopped.needs_consent = true;
  const std::string advice = app::stop_advice(stopped);
  const auto times_told = [&] {
    std::size_t times = 0;
    for (std::size_t at = 0; (at = terminal.written.find(advice, at)) != std::string::npos; ++at) {
      ++times;
    }
    return times;
  };
  terminal.desk.show(exploring());
  terminal.desk.show(stopped);
  terminal.desk.show(stopped);
  CHECK(times_told() == 1);
  CHECK(terminal.written.find('\a') != std::string::npos);
  terminal.desk.show(exploring());
  terminal.desk.show(stopped);
  CHECK(times_told() == 2);
}

TEST_CASE("lines of standard output do not run into the line that is overwritten") {
  Terminal terminal;
  terminal.desk.show(exploring());
  terminal.written.clear();
  terminal.desk.acknowledged(3);
  CHECK(terminal.written == "\r\x1b[K");
  terminal.desk.show(exploring());
  terminal.written.clear();
  terminal.face->end_line();
  CHECK(terminal.written == "\n");
  terminal.face->end_line();
  CHECK(terminal.written == "\n");
}

TEST_CASE("force requires a key press while nothing is missing") {
  using Reply = session::Attendant::Reply;
  Terminal terminal;
  app::ExperimenterDesk& desk = terminal.desk;
  terminal.keys = "g";
  CHECK(desk.poll("move the handle") == Reply::wait);
  CHECK(desk.poll("") == Reply::wait);
  // Meanwhile, the session takes requests and shows its status.
  CHECK(terminal.typed("g").empty());
  desk.show(exploring());
  CHECK(desk.poll("") == Reply::arm);
  CHECK(desk.poll("") == Reply::wait);
  CHECK(terminal.typed("g").empty());
  CHECK(desk.poll("put it into the inkwell") == Reply::wait);
  CHECK(desk.poll("") == Reply::wait);
  // A note in between: the line that announces the force has to be shown again.
  CHECK(terminal.typed("gnlate\n").size() == 1);
  CHECK(desk.poll("") == Reply::wait);
  terminal.keys = "ayes\nfire alarm\n";
  CHECK(desk.poll("") == Reply::stop);
  CHECK(terminal.typed("").at(0).text == "fire alarm");
}

TEST_CASE("the arm is at its reset position by a key that is pressed when the line asks for it") {
  using Reply = session::Attendant::Reply;
  Terminal terminal;
  app::ExperimenterDesk& desk = terminal.desk;
  CHECK(terminal.typed("h").empty());
  CHECK(desk.poll("reset the arm") == Reply::wait);
  terminal.keys = "h";
  CHECK(desk.poll("reset the arm") == Reply::at_reset);
  CHECK(desk.poll("reset the arm") == Reply::wait);
  terminal.keys = "h";
  CHECK(desk.poll("") == Reply::wait);
}

TEST_CASE("the line says how the hand presses and strokes while it is at the plane") {
  session::SessionStatus status = exploring();
  status.rate_hz = 1000.0;
  CHECK_THAT(app::status_line(status), holds_text("1000/s") && !holds_text("force"));
  status.hand = session::HandLevels{session::HandLevel::low, session::HandLevel::high};
  CHECK_THAT(app::status_line(status),
             holds_text("force low  speed high") && !holds_text("1000/s"));
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

/// A terminal before a participant who feels sand, bark or cloth.
struct SpokenTerminal : Terminal {
  SpokenTerminal() {
    spoken.see_pictures({"sand", "bark", "cloth"});
    step.trial = 7;
    step.sight = study::Sight::blindfold;
  }
  /// The reply after these keys.
  std::optional<session::StepReply> reply(const std::string& more) {
    keys += more;
    return spoken.show_step(step);
  }

  Blindfolded participant;
  app::SpokenAnswers spoken{participant, desk};
  session::AnswerStep step;
};

TEST_CASE("a spoken answer is entered by its number in alphabetical order") {
  SpokenTerminal terminal;
  terminal.step.confidence_levels = 5;
  CHECK_FALSE(terminal.reply(""));
  std::vector<std::string> labels;
  for (const auto& choice : terminal.desk.view().question.choices) labels.push_back(choice.label);
  CHECK(labels == std::vector<std::string>{"bark", "cloth", "sand"});
  CHECK_FALSE(terminal.reply("9\n1\n3\n2\n"));
  CHECK_THAT(terminal.written, holds_text("trial 7: sand"));
  // Keys that are read while the session takes requests still belong to the answer.
  CHECK(terminal.typed("\n6\n4").empty());
  const auto reply = terminal.reply("\n");
  REQUIRE(reply);
  CHECK(position_of(reply->answer) == 0);
  CHECK(first_position_of(reply->answer) == 1);
  CHECK(reply->confidence == 4);
  CHECK(reply->at);
}

TEST_CASE("an unfinished entry is discarded at the next exploration") {
  SpokenTerminal terminal;
  CHECK_FALSE(terminal.reply("3\n"));
  CHECK_FALSE(terminal.reply(""));
  CHECK_THROWS_AS(terminal.spoken.begin_exploring(PlaneGeometry{}), std::logic_error);
  CHECK_FALSE(terminal.reply("\n"));
  CHECK_FALSE(terminal.reply(""));
}

TEST_CASE("participants who see answer for themselves") {
  SpokenTerminal terminal;
  terminal.step.sight = study::Sight::curtain;
  const auto reply = terminal.reply("");
  REQUIRE(reply);
  CHECK(position_of(reply->answer) == 2);
}

}  // namespace
}  // namespace touchtrial
