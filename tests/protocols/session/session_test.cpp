#include "protocols/session/session.hpp"

#include "core/errors.hpp"
#include "record/payload_json.hpp"
#include "support/as_recorded.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <memory>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using std::chrono::seconds;
using Phase = session::SessionPhase;
using Input = session::SessionInput;

/// Stores in memory, and refuses events on request, as a full disk does.
class FickleSink final : public record::EventSink {
 public:
  void accept(const record::Event& event,
              const std::optional<record::SealedTrace>& trace) override {
    if (refuses) throw StoreError("the disk is full");
    stored.accept(event, trace);
  }
  bool refuses = false;
  record::BufferedEvents stored;
};

study::Schedule schedule_of(int trials) {
  study::Schedule schedule;
  for (int i = 0; i < trials; ++i) {
    schedule.trials.push_back(
        {.place = {.trial = i + 1, .block = i / 2}, .planes = {{.field = {.class_index = i % 3}}}});
  }
  schedule.layout = {2, 0, 1};
  return schedule;
}

std::unique_ptr<study::Order> order_of(int trials) {
  return std::make_unique<study::Order>(schedule_of(trials), SecretKey{});
}

/// A session in which everything before the first trial is done, at 3 s.
struct Laboratory {
  explicit Laboratory(int trials = 3, const study::TrialOptions& options = {})
      : session(order_of(trials), options, record::SessionRecorder(1, SecretKey{}, sink)) {
    opening.participant = "P001";
    opening.enrolment = 1;
    session.open(seconds(1), opening, "{}");
    session.calibrate(seconds(2));
    session.instruct(seconds(3));
  }

  void run_trial(int position) {
    session.present(now += seconds(1));
    session.contact(now += seconds(1));
    session.end_exploring(now += seconds(1));
    session.choose(position);
    session.confirm(now += seconds(1));
  }

  [[nodiscard]] std::vector<record::EventKind> kinds() const {
    std::vector<record::EventKind> kinds;
    for (const record::Event& event : sink.stored.events) kinds.push_back(event.kind);
    return kinds;
  }
  [[nodiscard]] nlohmann::json last_body() const {
    return nlohmann::json::parse(as_recorded(sink.stored.events.back(), SecretKey{}).body);
  }

  FickleSink sink;
  record::SessionOpening opening;
  session::Session session;
  seconds now{3};
};

/// The inputs that the session takes now.
std::vector<Input> accepted(const session::Session& session) {
  std::vector<Input> inputs;
  for (int i = 0; i <= static_cast<int>(Input::close); ++i) {
    if (session.accepts(static_cast<Input>(i))) inputs.push_back(static_cast<Input>(i));
  }
  return inputs;
}

TEST_CASE("a session goes from opening to closing and records each step") {
  Laboratory lab(2);
  lab.run_trial(1);
  lab.run_trial(0);
  CHECK(lab.session.phase() == Phase::finished);
  CHECK(lab.session.current() == nullptr);
  lab.session.close(lab.now);
  using Kind = record::EventKind;
  const std::vector<Kind> expected = {
      Kind::opened,   Kind::calibrated, Kind::instructed,    Kind::presented, Kind::first_contact,
      Kind::answered, Kind::presented,  Kind::first_contact, Kind::answered,  Kind::closed};
  CHECK(lab.kinds() == expected);
  CHECK(lab.last_body().at("complete") == true);
}

TEST_CASE("each phase takes its own inputs and no others") {
  Laboratory lab(2);
  session::Session& session = lab.session;
  using List = std::vector<Input>;
  CHECK(accepted(session) == List{Input::present, Input::practise, Input::take_break, Input::pause,
                                  Input::note, Input::stop});
  session.present(seconds(4));
  CHECK(accepted(session) == List{Input::contact, Input::end_exploring, Input::time_out,
                                  Input::interrupt, Input::keep_evidence, Input::note,
                                  Input::stop});
  session.end_exploring(seconds(5));
  CHECK(accepted(session) == List{Input::interrupt, Input::keep_evidence, Input::explore_again,
                                  Input::choose, Input::pause, Input::note, Input::stop});
  session.choose(0);
  CHECK(accepted(session) == List{Input::interrupt, Input::keep_evidence, Input::explore_again,
                                  Input::choose, Input::confirm, Input::pause, Input::note,
                                  Input::stop});
  session.pause(seconds(6), "coffee");
  CHECK(accepted(session) == List{Input::resume, Input::note, Input::stop});
  session.stop(seconds(7), "fire alarm");
  CHECK(accepted(session) == List{Input::note, Input::close});
  session.close(seconds(8));
  CHECK(accepted(session).empty());
}

TEST_CASE("an input that does not fit throws, and changes and records nothing") {
  Laboratory lab;
  const std::size_t recorded = lab.sink.stored.events.size();
  const std::map<Input, std::function<void()>> misfits = {
      {Input::open, [&] { lab.session.open(seconds(9), lab.opening, "{}"); }},
      {Input::calibrate, [&] { lab.session.calibrate(seconds(9)); }},
      {Input::instruct, [&] { lab.session.instruct(seconds(9)); }},
      {Input::contact, [&] { lab.session.contact(seconds(9)); }},
      {Input::end_exploring, [&] { lab.session.end_exploring(seconds(9)); }},
      {Input::time_out, [&] { lab.session.time_out(seconds(9)); }},
      {Input::interrupt, [&] { lab.session.interrupt(seconds(9), "why"); }},
      {Input::keep_evidence, [&] { lab.session.keep_evidence({}); }},
      {Input::explore_again, [&] { lab.session.explore_again(seconds(9)); }},
      {Input::choose, [&] { lab.session.choose(0); }},
      {Input::confirm, [&] { lab.session.confirm(seconds(9)); }},
      {Input::resume, [&] { lab.session.resume(seconds(9)); }},
      {Input::close, [&] { lab.session.close(seconds(9)); }}};
  for (const auto& [input, act] : misfits) {
    CHECK_FALSE(lab.session.accepts(input));
    CHECK_THROWS_WITH(act(), holds_text("ready") && holds_text(std::string(name_of(input))));
  }
  CHECK(lab.session.phase() == Phase::ready);
  CHECK(lab.sink.stored.events.size() == recorded);
}

TEST_CASE("time cannot go back") {
  Laboratory lab;
  CHECK_THROWS_AS(lab.session.present(seconds(2)), std::logic_error);
  CHECK_NOTHROW(lab.session.present(seconds(3)));
}

TEST_CASE("a choice can be changed once before Next, and both are recorded") {
  Laboratory lab;
  lab.session.present(seconds(4));
  lab.session.end_exploring(seconds(5));
  lab.session.choose(2);
  lab.session.choose(2);  // the same again is no change
  lab.session.choose(0);
  CHECK_THROWS_AS(lab.session.choose(1), std::logic_error);
  lab.session.confirm(seconds(6), 3);
  CHECK(lab.last_body().at("trial") == 1);
  CHECK(lab.last_body().at("position") == 0);
  CHECK(lab.last_body().at("first_position") == 2);
  CHECK(lab.last_body().at("confidence") == 3);
}

TEST_CASE("there is no picture beyond the layout") {
  Laboratory lab;
  lab.session.present(seconds(4));
  lab.session.end_exploring(seconds(5));
  CHECK_THROWS_AS(lab.session.choose(3), std::invalid_argument);
  CHECK_THROWS_AS(lab.session.choose(-1), std::invalid_argument);
  CHECK(lab.session.phase() == Phase::answering);
}

TEST_CASE("an answer counts only once the sink has taken it") {
  Laboratory lab(1);
  lab.session.present(seconds(4));
  lab.session.end_exploring(seconds(5));
  lab.session.choose(1);
  lab.sink.refuses = true;
  CHECK_THROWS_AS(lab.session.confirm(seconds(6)), StoreError);
  CHECK(lab.session.phase() == Phase::chosen);
  CHECK(lab.session.presentations_left() == 1);
  lab.sink.refuses = false;
  lab.session.confirm(seconds(7));
  CHECK(lab.session.phase() == Phase::finished);
  CHECK(lab.kinds().back() == record::EventKind::answered);
}

TEST_CASE("a plane that could not be recorded is not presented") {
  Laboratory lab;
  lab.sink.refuses = true;
  CHECK_THROWS_AS(lab.session.present(seconds(4)), StoreError);
  CHECK(lab.session.phase() == Phase::ready);
}

TEST_CASE("an interrupted trial is repeated after all others, under its number") {
  Laboratory lab(3);
  lab.session.present(lab.now += seconds(1));
  lab.session.interrupt(lab.now += seconds(1), "comfort stop");
  CHECK(lab.last_body().at("reason") == "comfort stop");
  std::vector<int> trials;
  while (lab.session.phase() == Phase::ready) {
    trials.push_back(lab.session.current()->place.trial);
    lab.run_trial(0);
  }
  CHECK(trials == std::vector<int>{2, 3, 1});
}

TEST_CASE("a presentation interrupted by a pause is the next one under every policy") {
  for (const auto policy : {study::OnInterruption::repeat, study::OnInterruption::leave_out}) {
    Laboratory lab(3, {.on_interruption = policy});
    lab.session.present(lab.now += seconds(1));
    CHECK_FALSE(lab.session.accepts(Input::pause));
    lab.session.interrupt(lab.now += seconds(1), record::kPauseReason);
    lab.session.pause(lab.now += seconds(1), "telephone");
    CHECK_FALSE(lab.last_body().contains("trial"));
    lab.session.resume(lab.now += seconds(9));
    std::vector<int> trials;
    while (lab.session.phase() == Phase::ready) {
      trials.push_back(lab.session.current()->place.trial);
      lab.run_trial(0);
    }
    CHECK(trials == std::vector<int>{1, 2, 3});
  }
}

TEST_CASE("a pause that an answer waits for names the trial, and the answer has no time") {
  Laboratory lab(1);
  lab.session.present(lab.now += seconds(1));
  lab.session.end_exploring(lab.now += seconds(1));
  lab.session.pause(lab.now += seconds(1), "telephone");
  CHECK(lab.last_body().at("trial") == 1);
  lab.session.resume(lab.now += seconds(90));
  CHECK(lab.last_body().at("trial") == 1);
  lab.session.choose(0);
  lab.session.confirm(lab.now += seconds(1));
}

record::TrialEvidence evidence_of(const session::Session& session, double height_mm) {
  record::TraceBody body{.trial = 1};
  return session.pack_evidence(body, {}, {1000.0, {{{1.0, 2.0, height_mm}, {0.0, 0.0, 0.5}}}});
}

TEST_CASE("an answer is stored with the evidence kept last, and with no other") {
  Laboratory lab;
  lab.session.present(seconds(4));
  const record::TrialEvidence first = evidence_of(lab.session, 3.0);
  const record::TrialEvidence last = evidence_of(lab.session, 4.0);
  lab.session.keep_evidence(first);
  lab.session.end_exploring(seconds(5));
  lab.session.explore_again(seconds(6));
  lab.session.end_exploring(seconds(7));
  lab.session.keep_evidence(last);
  CHECK(lab.sink.stored.traces.empty());
  lab.session.choose(1);
  lab.session.confirm(seconds(8));
  REQUIRE(lab.sink.stored.traces.size() == 1);
  CHECK(lab.sink.stored.traces.front().box == last.trace.box);
  const std::vector<record::EventKind> kinds = lab.kinds();
  CHECK(kinds[kinds.size() - 3] == record::EventKind::explored_again);
  CHECK(kinds[kinds.size() - 2] == record::EventKind::trace_stored);
  CHECK(kinds.back() == record::EventKind::answered);
}

TEST_CASE("a trial can be interrupted while the participant answers; its evidence is forgotten") {
  Laboratory lab(2);
  lab.session.present(seconds(4));
  lab.session.keep_evidence(evidence_of(lab.session, 3.0));
  lab.session.end_exploring(seconds(5));
  lab.session.choose(1);
  lab.session.interrupt(seconds(6), "comfort stop: a cramp");
  CHECK(lab.session.current()->place.trial == 2);
  lab.now = seconds(6);
  lab.run_trial(0);
  lab.run_trial(0);
  CHECK(lab.session.phase() == Phase::finished);
  CHECK(lab.sink.stored.traces.empty());
}

TEST_CASE("once time is up, the participant cannot go back to the plane") {
  Laboratory lab;
  lab.session.present(seconds(4));
  lab.session.time_out(seconds(64));
  CHECK_THROWS_AS(lab.session.explore_again(seconds(65)), std::logic_error);
}

TEST_CASE("an interrupted trial is left out if the study says so") {
  study::TrialOptions options{.on_interruption = study::OnInterruption::leave_out};
  Laboratory lab(2, options);
  lab.session.present(seconds(4));
  lab.session.interrupt(seconds(5), "device lost");
  CHECK(lab.session.presentations_left() == 1);
  lab.now = seconds(5);
  lab.run_trial(0);
  CHECK(lab.session.phase() == Phase::finished);
}

TEST_CASE("when time is up an answer is still required") {
  Laboratory lab;
  lab.session.present(seconds(4));
  lab.session.time_out(seconds(64));
  CHECK(lab.session.phase() == Phase::answering);
  lab.session.choose(1);
  lab.session.confirm(seconds(66));
  CHECK(lab.session.presentations_left() == 2);
}

TEST_CASE("when time is up and the study says no-response, the trial is over without an answer") {
  study::TrialOptions options{.on_timeout = study::OnTimeout::no_response};
  Laboratory lab(1, options);
  lab.session.present(seconds(4));
  lab.session.time_out(seconds(64));
  CHECK(lab.session.phase() == Phase::finished);
  CHECK(lab.kinds().back() == record::EventKind::timed_out);
}

TEST_CASE("only the first contact of a presentation is recorded") {
  Laboratory lab;
  lab.session.present(seconds(4));
  lab.session.contact(seconds(5));
  lab.session.contact(seconds(6));
  CHECK(std::ranges::count(lab.kinds(), record::EventKind::first_contact) == 1);
  lab.session.interrupt(seconds(7), "again");
  lab.session.present(seconds(8));
  lab.session.contact(seconds(9));
  CHECK(std::ranges::count(lab.kinds(), record::EventKind::first_contact) == 2);
}

TEST_CASE("a break is due when the study says so") {
  study::TrialOptions options{.break_every = 2};
  Laboratory lab(4, options);
  CHECK_FALSE(lab.session.is_break_due());
  lab.run_trial(0);
  CHECK_FALSE(lab.session.is_break_due());
  lab.run_trial(0);
  CHECK(lab.session.is_break_due());
  lab.session.take_break(lab.now, "ten minutes");
  CHECK_FALSE(lab.session.is_break_due());
  lab.run_trial(0);
  lab.run_trial(0);
  CHECK_FALSE(lab.session.is_break_due());  // nothing comes after it
}

TEST_CASE("after a pause the session continues in the phase where it stopped") {
  Laboratory lab;
  lab.session.present(seconds(4));
  lab.session.end_exploring(seconds(5));
  lab.session.choose(1);
  lab.session.pause(seconds(6), "telephone");
  lab.session.resume(seconds(60));
  CHECK(lab.session.phase() == Phase::chosen);
  lab.session.confirm(seconds(61));
  CHECK(lab.last_body().at("position") == 1);
}

TEST_CASE("a session that was stopped closes as incomplete") {
  Laboratory lab;
  lab.session.present(seconds(4));
  lab.session.stop(seconds(5), "the participant feels unwell");
  lab.session.close(seconds(6));
  CHECK(lab.last_body().at("complete") == false);
}

session::SerialiseBlock no_secret() {
  return [](const std::vector<study::Trial>&) { return std::string("{}"); };
}

study::TrialOptions restarting_blocks() {
  return {.on_interruption = study::OnInterruption::restart_block};
}

TEST_CASE("an interrupted trial restarts its block, under new numbers, if the study says so") {
  FickleSink sink;
  session::Session session(order_of(4), restarting_blocks(),
                           record::SessionRecorder(1, SecretKey{}, sink), no_secret());
  session.open({}, {}, "{}");
  session.calibrate({});
  session.instruct({});
  std::vector<int> trials;
  for (int i = 0; session.phase() == Phase::ready; ++i) {
    trials.push_back(session.current()->place.trial);
    session.present({});
    if (i == 1) {
      session.interrupt({}, "device lost");
      continue;
    }
    session.end_exploring({});
    session.choose(0);
    session.confirm({});
  }
  CHECK(trials == std::vector<int>{1, 2, 5, 6, 3, 4});
  CHECK_THROWS_AS(session::Session(order_of(4), restarting_blocks(),
                                   record::SessionRecorder(1, SecretKey{}, sink)),
                  std::invalid_argument);
}

/// Runs a session that is killed after `kept` events, resumes it, and runs it to its end. Returns
/// the trials in the order in which they were answered.
std::vector<int> killed_after(std::size_t kept, const study::TrialOptions& options) {
  FickleSink first;
  const auto run = [](session::Session& session, FickleSink& sink, std::size_t most) {
    const auto over = [&] { return sink.stored.events.size() >= most; };
    const auto at = [&] { return session.last() + seconds(1); };
    while (session.phase() != Phase::closed && !over()) {
      switch (session.phase()) {
        case Phase::opened:
          session.calibrate(at());
          break;
        case Phase::calibrated:
          session.instruct(at());
          break;
        case Phase::ready:
          session.present(at());
          break;
        case Phase::exploring:
          session.contact(at());
          if (over()) return;
          session.end_exploring(at());
          session.choose(1);
          session.confirm(at());
          break;
        default:
          session.close(at());
      }
    }
  };
  session::Session session(order_of(4), options, record::SessionRecorder(1, SecretKey{}, first),
                           no_secret());
  session.open({}, {}, "{}");
  run(session, first, kept);

  FickleSink second;
  session::Session again(order_of(4), options, record::SessionRecorder(1, SecretKey{}, second),
                         no_secret());
  const std::vector<record::Event> so_far = as_recorded(first.stored.events, SecretKey{});
  again.restore(so_far);
  CHECK(again.last() == so_far.back().at);
  if (again.phase() != Phase::closed)
    again.resume_after_exit(again.last(), {"program-ended", 1.0, "1"});
  run(again, second, 1000);
  CHECK(again.phase() == Phase::closed);

  std::vector<int> answered;
  Digest head{};
  std::int64_t sequence = 0;
  for (const record::BufferedEvents* part : {&first.stored, &second.stored}) {
    for (const record::Event& event : part->events) {
      CHECK(event.previous == head);
      CHECK(event.sequence == sequence++);
      head = event.hash;
      if (event.kind != record::EventKind::answered) continue;
      answered.push_back(nlohmann::json::parse(event.body).at("trial"));
    }
  }
  return answered;
}

TEST_CASE("a session is resumed where it stopped, after whichever event it was killed") {
  // opened, calibrated, instructed, then three events a trial, closed.
  for (std::size_t kept = 1; kept <= 16; ++kept) {
    CAPTURE(kept);
    std::vector<int> repeated = killed_after(kept, {});
    CHECK(repeated.size() == 4);
    std::ranges::sort(repeated);
    CHECK(repeated == std::vector<int>{1, 2, 3, 4});

    study::TrialOptions options{.on_interruption = study::OnInterruption::leave_out};
    const bool in_trial = kept > 3 && kept < 16 && (kept - 3) % 3 != 0;
    CHECK(killed_after(kept, options).size() == (in_trial ? 3U : 4U));

    // The block's last answers are those that count.
    const std::vector<int> restarted = killed_after(kept, restarting_blocks());
    CHECK(restarted.size() == (in_trial && ((kept - 4) / 3) % 2 == 1 ? 5U : 4U));
  }
}

TEST_CASE("resuming a session ends its pause, and asks nothing twice") {
  Laboratory lab;
  lab.session.tick(seconds(3), "curtain");
  lab.session.deviate(seconds(3), {"no-masking-noise", "no headphones"});
  lab.session.question(seconds(3), "handedness", "{}");
  lab.session.practise(seconds(3), {1, 1, ChoiceAnswer{2}, true});
  lab.session.pause(seconds(4), "telephone");
  FickleSink sink;
  session::Session again(order_of(3), {}, record::SessionRecorder(1, SecretKey{}, sink));
  again.restore(as_recorded(lab.sink.stored.events, SecretKey{}));
  CHECK(again.phase() == Phase::paused);
  again.resume_after_exit(seconds(5), {"program-ended", 1.0, "1"});
  CHECK(again.phase() == Phase::ready);
  CHECK(again.remarks().ticked.contains("curtain"));
  CHECK(again.remarks().deviations.contains("no-masking-noise"));
  CHECK(again.remarks().questionnaires.contains("handedness"));
  REQUIRE(again.remarks().practice.size() == 1);
  CHECK(again.remarks().practice.front().correct == true);
}

TEST_CASE("events that do not fit the schedule are refused") {
  Laboratory lab(1);
  lab.session.present(seconds(4));
  FickleSink sink;
  study::Schedule other = schedule_of(1);
  other.trials.front().place.trial = 2;
  session::Session again(std::make_unique<study::Order>(other, SecretKey{}), {},
                         record::SessionRecorder(1, SecretKey{}, sink));
  CHECK_THROWS_WITH(again.restore(as_recorded(lab.sink.stored.events, SecretKey{})),
                    holds_text("verify"));
}

/// The end of a session whose first answers are at position 1 and the rest at 0, taken up after the
/// first five.
std::string end_of(int answers, int at_1, bool may_name_one_key) {
  Laboratory lab(answers);
  for (int trial = 1; trial <= 5; ++trial) lab.run_trial(trial <= at_1 ? 1 : 0);
  FickleSink sink;
  session::Session again(order_of(answers), {}, record::SessionRecorder(1, SecretKey{}, sink));
  again.restore(as_recorded(lab.sink.stored.events, SecretKey{}));
  std::chrono::nanoseconds now = again.last();
  again.resume_after_exit(now, {"program-ended", 1.0, "1"});
  for (int trial = 6; trial <= answers; ++trial) {
    again.present(now += seconds(1));
    again.end_exploring(now += seconds(1));
    again.choose(0);
    again.confirm(now += seconds(1));
  }
  again.close(now, may_name_one_key);
  return sink.stored.events.back().body;
}

TEST_CASE(
    "a session's end flags a participant who presses one key, and reveals nothing else about "
    "answers") {
  CHECK(end_of(20, 1, true) == R"({"answers":20,"complete":true,"one_key":true})");
  CHECK(end_of(20, 2, true) == R"({"answers":20,"complete":true})");
  CHECK(end_of(19, 0, true) == R"({"answers":19,"complete":true})");
  CHECK(end_of(40, 2, true) == R"({"answers":40,"complete":true,"one_key":true})");
  CHECK(end_of(40, 0, false) == R"({"answers":40,"complete":true})");
}

TEST_CASE("a session without answers ends without their number") {
  Laboratory lab(0);
  lab.session.close(seconds(4), true);
  CHECK(lab.sink.stored.events.back().body == R"({"complete":true})");
}

TEST_CASE("a session without presentations is finished once the participant is instructed") {
  Laboratory lab(0);
  CHECK(lab.session.phase() == Phase::finished);
}

}  // namespace
}  // namespace touchtrial
