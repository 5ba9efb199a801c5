#include "analysis/fake_study.hpp"

#include "engine/pack/pack.hpp"
#include "study/protocol.hpp"
#include "study/signed_pack.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using std::chrono::milliseconds;

constexpr int kRepeats = 4;

study::StudyKey fake_key(const study::Protocol& protocol, const FakeOptions& options) {
  nlohmann::json text = nlohmann::json::parse(fake_study_text(protocol, options.label));
  if (!options.trials.empty()) text["trials"].update(nlohmann::json::parse(options.trials));
  if (!options.registration.empty()) {
    text["registration"] = nlohmann::json::parse(options.registration);
  }
  if (!options.sections.empty()) text.update(nlohmann::json::parse(options.sections));
  if (!options.session.empty()) text["session"] = nlohmann::json::parse(options.session);
  const study::Study study = study::parse_study(text.dump(), ".", "fake.json");
  SeededEntropy entropy(11);
  study::StudyKey key = study::make_study_key(study, entropy, options.simulated);
  if (!options.stations.empty()) {
    std::vector<study::Station> stations = study::stations_named(options.stations);
    study::assign_enrolments(stations, 8);
    study::assign_stations(key, std::move(stations));
  }
  return key;
}

record::StudyCommitment fake_commitment(const study::StudyKey& key, const FakeOptions& options,
                                        const std::filesystem::path& pack) {
  record::StudyCommitment commitment;
  commitment.study = key.study.name;
  commitment.protocol = key.study.protocol_name();
  commitment.study_id = key.study_id;
  commitment.seal = study::study_seal(key);
  if (std::filesystem::exists(pack)) commitment.pack = engine::Pack(pack).digest();
  commitment.configuration = study::blinded_configuration(key);
  commitment.scored_trials = key.study.scored_trials();
  commitment.positions = static_cast<int>(key.study.classes.size());
  commitment.simulated = key.simulated;
  commitment.pilot = options.pilot;
  commitment.program_version = "0.0.0";
  commitment.investigator = key.investigator_signature;
  const study::StationKey station = study::station_key(key, key.stations.front().name);
  commitment.station = {.name = station.station.name,
                        .key = station.signer().public_half(),
                        .certificate = station.certificate};
  return commitment;
}

/// A pack of 2 x 2 pixel fields, one for each code.
std::filesystem::path fake_pack(const study::StudyKey& key, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  engine::PackManifest manifest{key.study_id, {}};
  for (const study::KeyedStimulus& stimulus : key.stimuli) {
    const engine::TextureField field({.geometry = {0.2, 2, 2}}, Plane<float>(2, 2));
    const Digest checksum = engine::write_field(folder, stimulus.code, field.view());
    manifest.entries.push_back({stimulus.code, checksum, {}, {0.01, 0.02}});
  }
  study::sign(manifest, key, {});
  engine::write_manifest(folder, manifest);
  return folder;
}

record::StudyStore fake_store(const study::StudyKey& key, const FakeOptions& options,
                              const std::filesystem::path& folder) {
  const auto pack = folder / "study.pack";
  if (options.with_pack) fake_pack(key, pack);
  return record::StudyStore::create(folder / "study.db", fake_commitment(key, options, pack),
                                    milliseconds(0), key.signer());
}

record::Trace fake_trace() {
  record::Trace trace;
  for (int i = 0; i < 20; ++i) trace.samples.push_back({{0.1 * i, 0.0, -0.5}, {0.0, 0.0, 0.25}});
  return trace;
}

int position_of(const study::Schedule& schedule, int class_index) {
  const auto found = std::find(schedule.layout.begin(), schedule.layout.end(), class_index);
  return static_cast<int>(found - schedule.layout.begin());
}

/// The n-th presentation begins at 10 n seconds.
void interrupt_trial(record::SessionRecorder& recorder, const study::Trial& shown, int place) {
  const milliseconds start(10'000 * place);
  recorder.presented(start, shown.place.trial, shown.place.block);
  recorder.interrupted(start + milliseconds(1000), shown.place.trial, "comfort stop");
}

/// The plane is touched after 0.5 s, and the answer comes 4.25 s later.
void record_trial(record::SessionRecorder& recorder, const FakeSession& session,
                  const study::Schedule& schedule, const study::Trial& shown, int place) {
  const milliseconds start(10'000 * place);
  recorder.presented(start, shown.place.trial, shown.place.block);
  recorder.first_contact(start + milliseconds(500), shown.place.trial);
  const FakeAnswers answers = session.answers ? session.answers : FakeStudy::always_right();
  if (const auto answer = answers(shown)) {
    recorder.answered(
        start + milliseconds(4250),
        {shown.place.trial, ChoiceAnswer{position_of(schedule, *answer)}, std::nullopt});
  } else {
    recorder.timed_out(start + milliseconds(4250), shown.place.trial);
  }
  record::TraceBody body{.trial = shown.place.trial, .rate_hz = 1000.0, .valid = session.valid};
  if (shown.place.trial % 2 == 0) body.hand = session.hand;
  body.servo = session.servo;
  recorder.trace_stored(start + milliseconds(4500), body,
                        {4.0, 300.5, 0.125, 0.001 * shown.place.trial, session.within_limits},
                        session.traces ? session.traces(shown) : fake_trace());
}

}  // namespace

FakeSession talkative(const std::string& participant, int enrolment, const std::string& closing) {
  return {.participant = participant,
          .enrolment = enrolment,
          .before_trials = [closing](record::SessionRecorder& recorder) {
            recorder.add(milliseconds(10), record::EventKind::questioned,
                         record::TextBody{"handedness"},
                         R"({"pen_hand":0,"spoon":1,"throwing":0,"toothbrush":0,"writing":0})");
            recorder.add(milliseconds(20), record::EventKind::paused,
                         record::PauseBody{.text = "a phone rang"});
            recorder.add(milliseconds(30), record::EventKind::resumed,
                         record::ResumedBody{.after = "pause", .away_s = 0.01});
            recorder.add(milliseconds(40), record::EventKind::noted,
                         record::RemarkBody{.text = "wears a ring"});
            for (int i = 1; i <= 3; ++i) {
              recorder.presented(milliseconds(1000 * i), 1, 0);
              recorder.interrupted(milliseconds(1000 * i + 500), 1, "comfort stop");
            }
            recorder.add(milliseconds(5000), record::EventKind::questioned,
                         record::TextBody{"closing"}, closing);
          }};
}

std::string fake_study_text(const study::Protocol& protocol, const std::string& first_label) {
  const bool comparison = protocol.all_methods;
  nlohmann::json study{{"study", comparison ? "pair" : "single"},
                       {"protocol", std::string(protocol.name)},
                       {"trials", {{"repeats", kRepeats}}},
                       {"seed", 5}};
  study["classes"] = {{{"label", first_label}, {"images", {"../stimuli/first.png"}}},
                      {{"label", "cloth"}, {"images", {"../stimuli/cloth.png"}}},
                      {{"label", "straw"}, {"images", {"../stimuli/straw.png"}}}};
  study["methods"] = {{{"name", "adaptive"}}};
  if (comparison) study["methods"].push_back({{"name", "tv-gabor"}});
  return study.dump();
}

FakeStudy::FakeStudy(const study::Protocol& protocol, const FakeOptions& options)
    : key_(fake_key(protocol, options)), store_(fake_store(key_, options, folder_.path())) {}

void FakeStudy::add(const FakeSession& session) {
  const int number = store_.next_session();
  SeededEntropy entropy(static_cast<std::uint64_t>(number));
  const SecretKey own = entropy.secret("participant");
  record::BufferedEvents buffer;
  record::SessionRecorder recorder(number, own, buffer);
  const study::Draws draws =
      key_.simulated || store_.commitment().pilot ? study::Draws::rehearsal : study::Draws::people;
  const study::Schedule schedule =
      study::make_schedule(key_.study, key_.draw_of(session.enrolment, draws, session.visit));
  record::SessionOpening opening{.visit = session.visit};
  const study::GroupPlan& groups = key_.study.groups;
  const auto group = key_.group_of(session.enrolment, draws);
  if (group && groups.open) opening.group = groups.labels[static_cast<std::size_t>(*group)];
  if (session.after.count() > 0) {
    const auto day = 1 + session.after.count() / 24;
    opening.opened_utc = (day < 10 ? "2026-03-0" : "2026-03-") + std::to_string(day) + "T09:00:00Z";
  }
  opening.participant = session.participant;
  opening.enrolment = session.enrolment;
  opening.study_id = key_.study_id;
  opening.seal = study::study_seal(key_);
  opening.device = "simulated";
  opening.simulated = key_.simulated;
  opening.pilot = store_.commitment().pilot;
  opening.station = session.station;
  recorder.opened(milliseconds(0), opening, study::schedule_to_json(schedule, key_));
  if (session.before_trials) session.before_trials(recorder);
  int place = 0;
  const study::Trial* again = nullptr;
  for (const study::Trial& shown : schedule.trials) {
    if (place == session.stop_after) break;
    if (shown.place.trial == session.interrupt_trial) {
      again = &shown;
      interrupt_trial(recorder, shown, ++place);
    } else {
      record_trial(recorder, session, schedule, shown, ++place);
    }
  }
  if (again != nullptr) record_trial(recorder, session, schedule, *again, ++place);
  const record::NewKeys keys = record::wrap_participant_key(key_.investigator_box, number, own);
  if (!session.ends) {
    const auto sink = store_.begin_session(number, keys, [=] { return milliseconds(number); });
    auto trace = buffer.traces.begin();
    for (const record::Event& event : buffer.events) {
      const bool has_trace = event.kind == record::EventKind::trace_stored;
      sink->accept(event, has_trace ? std::optional(*trace++) : std::nullopt);
    }
    return;
  }
  recorder.closed(milliseconds(10'000'000), session.complete, place, session.one_key);
  store_.add_session(buffer, keys, session.after + milliseconds(number));
}

void FakeStudy::close_and_unblind() {
  store_.close_study(milliseconds(1000));
  store_.unblind(milliseconds(1001), "planned", false);
}

FakeAnswers FakeStudy::always_right() {
  return [](const study::Trial& shown) { return shown.field().class_index; };
}

FakeAnswers FakeStudy::confusing(int from, int to) {
  return [=](const study::Trial& shown) {
    return shown.field().class_index == from ? to : shown.field().class_index;
  };
}

}  // namespace touchtrial
