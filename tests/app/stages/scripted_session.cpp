#include "app/stages/scripted_session.hpp"

#include "app/run/run_study.hpp"
#include "app/run/session_bounds.hpp"
#include "app/stages/drawn_console.hpp"
#include "app/texts/study_texts.hpp"
#include "app/windows/experimenter/experimenter_desk.hpp"
#include "app/windows/experimenter/terminal_face.hpp"
#include "device/servo/servo_clock.hpp"
#include "protocols/session/session_runner.hpp"
#include "study/protocol.hpp"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>
#include <map>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using nlohmann::json;
using Action = app::ExperimenterAction::Kind;

constexpr int kAbove = 20;      ///< ticks before the hand comes down
constexpr int kFeltFrom = 150;  ///< ticks whose forces say what was felt
constexpr int kFeltTo = 250;
constexpr int kTouched = 280;  ///< ticks after which somebody has touched enough
constexpr int kPolls = 3;      ///< looks at a step before the participant replies
constexpr std::chrono::milliseconds kThought{700};
constexpr std::chrono::seconds kTea{60};
constexpr char kEscape = '\x1b';

/// A hand that strokes to and fro along one line, whatever the force.
class Hand final : public device::HapticDevice {
 public:
  [[nodiscard]] device::DeviceInfo info() const override { return {"scripted", "", 3.3, true}; }
  [[nodiscard]] device::DeviceStatus read(device::DeviceSample& sample) noexcept override {
    constexpr double kStrokeMm = 16.0;
    constexpr double kStepMm = 0.1;
    const double way = std::fmod(kStepMm * tick, 2.0 * kStrokeMm);
    const double x = way < kStrokeMm ? way : 2.0 * kStrokeMm - way;
    const double z = std::clamp(5.0 - kStepMm * (tick - kAbove), -1.2, 5.0);
    sample.position_mm = {4.0 + x, 11.0, z};
    sample.velocity_mm_s = {way < kStrokeMm ? 100.0 : -100.0, 0.0, 0.0};
    sample.sequence = static_cast<std::uint64_t>(++tick);
    return device::DeviceStatus::ok;
  }
  [[nodiscard]] device::DeviceStatus write(Vec3 force_n) noexcept override {
    if (tick > kFeltFrom && tick <= kFeltTo) felt_n += std::hypot(force_n.x, force_n.y);
    return device::DeviceStatus::ok;
  }
  void halt() noexcept override {}
  void rearm() noexcept override {}

  int tick = 0;
  double felt_n = 0.0;  ///< sum along the plane
};

class Script final : public session::Participant,
                     public session::Experimenter,
                     public session::DeviceSupply,
                     public session::Explorer {
 public:
  Script(Deed deed, const std::filesystem::path& log, session::SessionClock& clock)
      : deed_(std::move(deed)), log_(log, std::ios::app), clock_(clock), desk_(true) {
    app::ExperimenterTerminal terminal;
    terminal.write = [](const std::string&) {};
    terminal.can_rewrite = true;
    terminal.key = [this]() -> std::optional<char> {
      if (keys_.empty()) return std::nullopt;
      const char key = keys_.front();
      keys_.erase(0, 1);
      return key;
    };
    terminal_.emplace(desk_, terminal);
    if (deed_.at_console) console_.emplace(desk_);
  }

  void write(const json& line) { log_ << line.dump() << std::endl; }

  // ---- The participant
  void see_pictures(const std::vector<std::string>& labels) override {
    choices_ = static_cast<int>(labels.size());
    write({{"is", "labels"}, {"labels", labels}});
  }
  [[nodiscard]] std::optional<session::StepReply> show_step(const session::Step& step) override {
    if (std::exchange(step_, step.index()) != step.index()) polls_ = 0;
    const auto* const interval = std::get_if<session::IntervalStep>(&step);
    is_between_ = interval != nullptr && interval->interval > 1;
    ++polls_;
    if (std::holds_alternative<session::PauseStep>(step)) return std::nullopt;
    if (const auto* const notice = std::get_if<session::NoticeStep>(&step)) {
      if (!notice->can_resume) return std::nullopt;
    }
    if (const auto* const asked = std::get_if<session::AnswerStep>(&step); asked && polls_ == 1) {
      write({{"is", "asked"}, {"practice", asked->practice}});
    }
    if (polls_ < kPolls) return std::nullopt;
    polls_ = 0;
    return reply_to(step);
  }
  [[nodiscard]] device::HapticDevice& begin_exploring(const PlaneGeometry&) override {
    is_between_ = false;
    hand_ = Hand();
    is_on_ = true;
    return hand_;
  }
  void while_exploring(device::ServoControl& servo) override {
    look();
    if (wants_stop_) servo.comfort_stop();
    if (hand_.tick > kTouched + 40 && step_ != session::Step(session::IntervalStep{}).index()) {
      servo.finish();
    }
  }
  void feel(const device::ServoSample&) noexcept override {}

  // ---- The plane, in virtual time
  [[nodiscard]] session::Exploration explore(device::ForceSource& force, const PlaneGeometry& plane,
                                             session::Participant& participant,
                                             const device::ServoOptions& options,
                                             record::Trace& trace) override {
    struct Sink final : device::SampleSink {
      session::TraceBuilder& builder;
      explicit Sink(session::TraceBuilder& to) : builder(to) {}
      void record(const device::ServoSample& sample) noexcept override { builder.add(sample); }
    };
    struct Clock final : device::ServoClock {
      session::Participant& person;
      device::ServoControl control;
      Time now_at{};
      int waits = 0;
      explicit Clock(session::Participant& of) : person(of) {}
      [[nodiscard]] Time now() noexcept override { return now_at; }
      void wait_until(Time time) noexcept override {
        now_at = std::max(now_at, time);
        if (++waits % 10 == 0) person.while_exploring(control);
      }
    };
    session::TraceBuilder builder(trace, options.rate_hz, session::max_samples(options));
    device::HapticDevice& device = participant.begin_exploring(plane);
    Sink sink(builder);
    Clock clock(participant);
    device::ServoHooks hooks{.control = &clock.control};
    session::Exploration done;
    done.servo = device::run_servo(device, force, sink, options, clock, hooks);
    done.landed_at = builder.landed_at();
    done.duration = session::time_of_tick(done.servo.ticks, options.rate_hz);
    is_on_ = wants_stop_ = false;
    write({{"is", "felt"},
           {"ms", hand_.tick},
           {"touched", hand_.tick >= kTouched},
           {"n", hand_.tick >= kFeltTo ? json(hand_.felt_n) : json(nullptr)}});
    return done;
  }

  // ---- The experimenter
  void show(const session::SessionStatus& status) override {
    status_ = status;
    desk_.show(status);
  }
  [[nodiscard]] std::optional<session::ExperimenterRequest> request() override {
    look();
    if (std::exchange(leaves_, false)) {
      return session::ExperimenterRequest{session::ExperimenterRequest::Kind::leave, "script", ""};
    }
    return desk_.request();
  }
  [[nodiscard]] std::optional<std::vector<session::Tick>> day_sheet(
      const std::vector<session::DaySheetItem>& items) override {
    const app::ExperimenterQuestion question = desk_.view().question;
    if (question.is_from_experimenter()) keys_ += kEscape;
    if (question.kind == app::ExperimenterQuestion::Kind::keys) keys_ += '\r';
    return desk_.day_sheet(items);
  }
  void acknowledged(int trial) override { write({{"is", "acknowledged"}, {"trial", trial}}); }

  // ---- The device
  [[nodiscard]] session::SupplyState make_ready() override {
    if (is_armed_) return session::SupplyState::ready;
    switch (desk_.poll("")) {
      case session::Attendant::Reply::arm:
        is_armed_ = true;
        return session::SupplyState::ready;
      case session::Attendant::Reply::stop:
        return session::SupplyState::stopped;
      default:
        return session::SupplyState::not_yet;
    }
  }
  void on_interruption() override { is_armed_ = false; }

 private:
  [[nodiscard]] session::StepReply reply_to(const session::Step& step) {
    session::StepReply reply;
    reply.took = std::chrono::milliseconds(100);
    if (const auto* const ready = std::get_if<session::ReadyStep>(&step)) {
      is_again_ = false;
      write({{"is", "ready"}, {"practice", ready->practice}, {"hand_off", ready->hand_off}});
    }
    if (std::holds_alternative<session::IntervalStep>(step)) {
      write({{"is", "lifted"}, {"ms", 100}});
    }
    if (const auto* const asked = std::get_if<session::QuestionStep>(&step)) {
      for (const auto& question : asked->questionnaire->questions) {
        reply.answers.push_back(question.kind == study::QuestionKind::choice ? "0" : "");
      }
      write(
          {{"is", "questions"}, {"name", asked->questionnaire->name}, {"answers", reply.answers}});
    }
    if (const auto* const asked = std::get_if<session::AnswerStep>(&step)) answer(*asked, reply);
    return reply;
  }
  /// Feels the second trial again, and changes every third answer.
  void answer(const session::AnswerStep& step, session::StepReply& reply) {
    reply.took = kThought;
    const bool again = step.may_explore_again && answers_ == 1 && !has_felt_again_;
    if (again) is_again_ = has_felt_again_ = reply.explore_again = true;
    ChoiceAnswer chosen;
    if (!again) {
      chosen.position = (5 * answers_ + 1) % choices_;
      if (answers_ % 3 == 2) chosen.first_position = (chosen.position + 1) % choices_;
      reply.answer = chosen;
      if (step.confidence_levels > 0) reply.confidence = 1 + answers_ % step.confidence_levels;
      if (!step.practice) ++answers_;
    }
    write({{"is", again ? "again" : "answer"},
           {"practice", step.practice},
           {"ms", kThought.count()},
           {"position", chosen.position},
           {"first", chosen.first_position ? json(*chosen.first_position) : json(nullptr)},
           {"confidence", reply.confidence ? json(*reply.confidence) : json(nullptr)}});
  }

  /// The experimenter's stage, and finer while a plane is on.
  [[nodiscard]] std::string stage() const {
    std::string stage = status_.stage + (status_.practice ? " in practice" : "");
    if (is_on_ && hand_.tick >= kTouched) stage += ", touched";
    if (is_on_ && is_again_) stage += ", again";
    if (is_between_) stage += ", between planes";
    return stage;
  }
  /// Does the deed if its stage has come, and what follows from it.
  void look() {
    const std::string now = stage();
    if (std::exchange(seen_, now) != now) {
      write({{"is", "stage"}, {"stage", now}, {"time", ++times_[now]}});
    }
    if (!is_done_ && now == deed_.stage && times_[now] == deed_.time) do_it();
    const bool is_paused = status_.stage == "paused";
    if (is_paused && !std::exchange(had_tea_, true)) clock_.advance(kTea);
    if (is_paused && polls_ >= kPolls) press(Action::resume);
    if (!is_paused && status_.needs_consent && polls_ >= kPolls) press(Action::arm);
  }
  void do_it() {
    is_done_ = true;
    write({{"is", "deed"}, {"what", deed_.what}, {"stage", deed_.stage}});
    if (deed_.what == "kill") std::raise(SIGKILL);
    if (deed_.what == "leave") leaves_ = true;
    if (deed_.what == "own-stop") wants_stop_ = true;
    if (deed_.what == "abort") keys_ += "ayes\rwanted to go\r";
    if (deed_.what == "note") keys_ += "nthe telephone rang\rdno-curtain\rhalf of wha";
    if (deed_.what == "stop") press(Action::comfort_stop);
    if (deed_.what == "pause") press(Action::pause);
  }
  void press(Action what) {
    if (!desk_.view().allows(what)) return;
    if (console_) return console_->click(what);
    if (desk_.view().question.is_from_experimenter()) keys_ += kEscape;
    const bool asks_why = what == Action::pause || what == Action::comfort_stop;
    keys_ += app::kExperimenterActions.at(static_cast<std::size_t>(what)).key;
    if (asks_why) keys_ += '\r';
  }

  Deed deed_;
  std::ofstream log_;
  session::SessionClock& clock_;
  app::ExperimenterDesk desk_;
  std::string keys_;
  std::optional<app::TerminalFace> terminal_;
  std::optional<DrawnConsole> console_;
  session::SessionStatus status_;
  std::map<std::string, int> times_;
  std::string seen_;
  std::size_t step_ = 0;
  int polls_ = 0;
  int choices_ = 1;
  int answers_ = 0;
  Hand hand_;
  bool is_on_ = false;
  bool is_between_ = false;
  bool is_done_ = false;
  bool wants_stop_ = false;
  bool leaves_ = false;
  bool is_armed_ = false;
  bool is_again_ = false;
  bool has_felt_again_ = false;
  bool had_tea_ = false;
};

/// Practice as the study has it, on blank planes where a trial has one.
study::Practice scripted_practice(const study::Study& study, const study::ScheduleDraw& draw,
                                  int round) {
  if (study::trial_question_of(study).planes > 1) return study::practice_of(study, draw, round);
  study::Practice practice{.labels = {"sand", "cork"}, .trials = {}, .criterion = 2, .rounds = 1};
  for (const int right : {0, 1}) {
    practice.trials.push_back({.place = {.trial = right + 1},
                               .role = study::Role::practice,
                               .planes = {{.field = {}, .blank = true}},
                               .right = right});
  }
  return practice;
}

}  // namespace

void run_scripted(const app::RunOptions& options, const Deed& deed,
                  const std::filesystem::path& log) {
  const app::RunStudy study = app::run_study_for(options);
  app::RunDatabase database(options, study);
  const session::StimulusSource source(study.pack, study.key);
  const app::EnteredSession entered =
      app::enter_session(options, study, database, [](record::SessionOpening& opening) {
        opening.device = "scripted";
        opening.simulated = true;
      });
  session::VirtualSessionClock clock(entered.clock);
  Script script(deed, log, clock);
  script.write({{"is", options.on_existing == app::OnExisting::resume ? "resumed" : "session"},
                {"visit", options.visit}});
  session::SessionTexts texts = app::session_texts(study.key.study);
  texts.day_sheet.resize(2);
  const auto practice = [&](int round) {
    return scripted_practice(study.key.study, entered.draw, round);
  };
  const session::SessionTally tally =
      session::run_session(*entered.session, {.key = study.key,
                                              .source = source,
                                              .participant = script,
                                              .clock = clock,
                                              .explorer = script,
                                              .devices = script,
                                              .experimenter = script,
                                              .texts = texts,
                                              .practice = practice});
  script.write({{"is", "end"}, {"left", tally.left.has_value()}});
}

}  // namespace touchtrial
