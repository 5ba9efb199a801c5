// What a database tells whoever has no key.
#include "record/schema.hpp"
#include "record/store_fixture.hpp"
#include "support/catch.hpp"

#include <regex>
#include <vector>

using namespace touchtrial;
using namespace touchtrial::record;
using namespace touchtrial::fixture;

namespace {

/// How one participant answered, and when.
struct Course {
  std::vector<int> positions;
  std::optional<int> change_of_mind;
  std::optional<int> confidence;
  nanoseconds away{};
  std::size_t samples = 0;
  std::vector<std::int64_t> explorations;
  bool practised_well = false;
  std::string note;
};

void record_course(SessionRecorder& recorder, const Course& course) {
  nanoseconds now{0};
  const auto later = [&](nanoseconds least) { return now += least + course.away; };
  recorder.opened(now, opening(1), R"({"schedule":1})");
  recorder.add(later(seconds(1)), EventKind::instructed, TextBody{.text = ""});
  recorder.add(later(seconds(1)), EventKind::practised,
               PracticeBody{.round = 1,
                            .presentation = 1,
                            .answer = ChoiceAnswer{course.practised_well ? 0 : 1},
                            .correct = course.practised_well});
  recorder.add(later(seconds(1)), EventKind::noted, RemarkBody{.text = course.note});
  recorder.add(later(seconds(1)), EventKind::deviated, DeviationBody{"other", course.note});
  int trial = 0;
  for (const int position : course.positions) {
    recorder.presented(later(seconds(1)), ++trial, 0);
    recorder.first_contact(later(milliseconds(1)), trial);
    recorder.add(later(seconds(1)), EventKind::explored_again, TrialBody{trial});
    TraceBody body{.trial = trial, .samples = 0, .rate_hz = 1e3, .overruns = 0, .valid = true};
    body.explorations = course.explorations;
    const TrialEvidence evidence =
        recorder.pack_evidence(body, {.contact_s = 1.0 / static_cast<double>(course.samples)},
                               stroking(course.samples, course.practised_well ? 0.2 : 0.0));
    recorder.answered(later(seconds(2)),
                      {.trial = trial,
                       .answer = ChoiceAnswer{position, course.change_of_mind},
                       .confidence = course.confidence},
                      evidence);
  }
  recorder.add(later(seconds(1)), EventKind::paused, PauseBody{.text = course.note});
  recorder.add(
      later(seconds(1)), EventKind::resumed,
      ResumedBody{.after = "pause", .away_s = std::chrono::duration<double>(course.away).count()});
  recorder.closed(later(seconds(1)), true, static_cast<int>(course.positions.size()), false,
                  course.practised_well ? 3.2 : 0.4);
}

/// Every row of every table, one line each. Of blobs only the size; of what is hashed, "#".
std::vector<std::string> lines_of(const std::filesystem::path& path) {
  static const std::regex hash("[0-9a-f]{64}");
  SQLite::Database raw(path.string());
  std::vector<std::string> lines;
  for (const char* const table : kTables) {
    SQLite::Statement query(raw, "SELECT * FROM " + std::string(table) + " ORDER BY 1, 2");
    while (query.executeStep()) {
      std::string line = table;
      for (int i = 0; i < query.getColumnCount(); ++i) {
        const SQLite::Column cell = query.getColumn(i);
        line += '|' + (cell.isBlob() ? std::to_string(cell.getBytes()) + " bytes"
                                     : std::regex_replace(cell.getString(), hash, "#"));
      }
      lines.push_back(line);
    }
  }
  return lines;
}

std::vector<std::string> lines_after(const Course& course) {
  StoredFixture study;
  BufferedEvents events;
  SessionRecorder recorder(1, participant_key(1), events);
  record_course(recorder, course);
  study.store->add_session(events, wrapped_key_of(1), kUtc);
  REQUIRE_FALSE(study.store->first_fault());
  REQUIRE(opened_events(*study.store, 1).back().at > course.away);
  study.store.reset();
  return lines_of(study.path);
}

}  // namespace

TEST_CASE("two studies that differ in answers and times alone differ in ciphertext and hashes") {
  const Course one{.positions = {0, 0, 3, 3},
                   .change_of_mind = {},
                   .confidence = 1,
                   .away = nanoseconds(1),
                   .samples = 1001,
                   .explorations = {},
                   .practised_well = false,
                   .note = ""};
  const Course other{.positions = {4, 1, 1, 4},
                     .change_of_mind = 2,
                     .confidence = 100,
                     .away = std::chrono::minutes(3) + nanoseconds(123'456'789),
                     .samples = 1999,
                     .explorations = {1000, 999},
                     .practised_well = true,
                     .note = "sneezed, and asked how long it would take"};
  const std::vector<std::string> lines = lines_after(one);
  REQUIRE(lines.size() > 30);
  REQUIRE(lines == lines_after(other));
}
