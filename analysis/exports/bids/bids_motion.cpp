#include "analysis/exports/bids/bids_motion.hpp"

#include "analysis/exports/bids/bids_sidecars_json.hpp"
#include "analysis/exports/trial_tables.hpp"
#include "analysis/outcomes/sealed_sessions.hpp"
#include "core/errors.hpp"
#include "core/outputs.hpp"
#include "record/marks.hpp"
#include "record/payload_json.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <memory>
#include <mutex>

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

using std::chrono::nanoseconds;

/// State shared by recordings that are written concurrently.
struct SharedReading {
  SessionKeys keys;
  std::mutex store_mutex;
};

record::Trace read_trace(const DatasetSource& study, const record::TrialRow& row,
                         SharedReading& shared) {
  const auto box = [&] {
    const std::lock_guard lock(shared.store_mutex);
    return study.store.sealed_trace(row.session, row.trial);
  }();
  return open_trace(box, row, shared.keys);
}

struct TraceEvents {
  record::TraceBody body;
  std::vector<nanoseconds> timed_out{};  ///< times since the session's opening
};

std::map<record::TrialId, TraceEvents> trace_events(const record::StudyStore& store,
                                                    const SessionKeys& keys) {
  std::map<record::TrialId, TraceEvents> all;
  const auto visit = [&](const record::Event& stored) {
    const auto key = keys.find(stored.session);
    if (key == keys.end() || !key->second.participant) return;
    const record::Event event = open_event(stored, *key->second.participant).event;
    if (event.kind == record::EventKind::timed_out) {
      const int trial = record::from_json<record::TrialBody>(event.body).trial;
      all[{stored.session, trial}].timed_out.push_back(event.at);
    } else {
      record::TraceBody body = record::from_json<record::TraceBody>(event.body);
      all[{stored.session, body.trial}].body = std::move(body);
    }
  };
  store.for_each(record::EventKind::timed_out, visit);
  store.for_each(record::EventKind::trace_stored, visit);
  return all;
}

/// The duration of a number of samples.
nanoseconds duration_of(std::int64_t samples, double rate_hz) {
  constexpr double kNanosecondsPerS = 1e9;
  return nanoseconds(std::llround(static_cast<double>(samples) * kNanosecondsPerS / rate_hz));
}

/// Appends a number, given in steps of 10^-kDecimals, and a separator. This is several times faster
/// than formatting doubles, and never writes -0.000.
template <int kDecimals>
void put_fixed(std::string& text, std::int64_t steps, char separator) {
  constexpr std::int64_t kSteps = [] {
    std::int64_t power = 1;
    for (int i = 0; i < kDecimals; ++i) power *= 10;
    return power;
  }();
  const std::int64_t magnitude = std::abs(steps);
  if (steps < 0) text += '-';
  const fmt::format_int integer_part(magnitude / kSteps);
  text.append(integer_part.data(), integer_part.size());
  text += '.';
  std::int64_t fraction = magnitude % kSteps;
  for (std::int64_t place = kSteps / 10; place > 0; fraction %= place, place /= 10) {
    text += static_cast<char>('0' + fraction / place);
  }
  text += separator;
}

void put_sample(std::string& text, const record::TraceSample& sample) {
  const Vec3& position = sample.position_mm;
  const Vec3& force = sample.force_n;
  for (const double position_mm : {position.x, position.y, position.z}) {
    put_fixed<3>(text, std::llround(position_mm * 1e3), '\t');
  }
  for (const double force_n : {force.x, force.y}) {
    put_fixed<4>(text, std::llround(force_n * 1e4), '\t');
  }
  put_fixed<4>(text, std::llround(force.z * 1e4), '\n');
}

/// The textures that a trial presented, as in *_beh.tsv.
DataCell texture_of(const DatasetSource& study, const TrialOutcome& trial) {
  static const std::string kNoParticipant;
  const std::span<const TrialColumn> columns = trial_columns();
  const auto column = std::ranges::find(columns, std::string_view("class"), &TrialColumn::name);
  return column->value({kNoParticipant, trial.row, false, study.outcomes, &trial});
}

/// The explorations and incidents of a run, ordered by time since its first sample, unknown times
/// last.
DataTable motion_events(const Recording& recording, const TraceEvents& events,
                        const record::TrialRow& row, const DataCell& texture) {
  DataTable table{motion_event_columns(), {}};
  const auto add = [&](DataCell onset, nanoseconds duration, record::Mark mark,
                       DataCell exploration) {
    table.rows.push_back(
        {std::move(onset), duration, texture, std::string(name_of(mark)), std::move(exploration)});
  };
  for (std::size_t i = 0; i < recording.samples.size(); ++i) {
    add(recording.starts[i] ? DataCell(*recording.starts[i]) : DataCell(),
        duration_of(recording.samples[i], recording.rate_hz), record::Mark::plane_on,
        static_cast<std::int64_t>(i) + 1);
  }
  const auto add_moment = [&](nanoseconds time, record::Mark mark) {
    add(time - recording.first_sample, {}, mark, {});
  };
  if (row.contact_at) add_moment(*row.contact_at, record::Mark::contact);
  for (const nanoseconds at : events.timed_out) {
    if (at >= row.presented_at) add_moment(at, record::Mark::time_up);
  }
  if (row.answered_at) add_moment(*row.answered_at, record::Mark::answered);
  std::ranges::stable_sort(table.rows, {}, [](const std::vector<DataCell>& cells) {
    const auto* onset = std::get_if<nanoseconds>(&cells.front());
    return onset != nullptr ? *onset : nanoseconds::max();
  });
  return table;
}

/// Date and time in BIDS format, with the date shifted (BidsSession::days).
std::string shifted_time(const BidsSession& session, nanoseconds since_opening) {
  const std::chrono::sys_days day =
      std::chrono::sys_days(std::chrono::year(1920) / 1 / 1) + session.days;
  const auto time = day + std::chrono::round<std::chrono::microseconds>(since_opening);
  const auto second = std::chrono::floor<std::chrono::seconds>(time);
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:06}", fmt::gmtime(second.time_since_epoch().count()),
                     (time - second).count());
}

class MotionFiles {
 public:
  MotionFiles(const DatasetSource& study, const DatasetOptions& options, const std::string& task)
      : study_(study), options_(options), task_(task), shared_(std::make_shared<SharedReading>()) {
    shared_->keys = person_keys(study.store, *study.key);
    events_ = trace_events(study.store, shared_->keys);
  }

  /// Adds the files that describe all recordings.
  void add_common() {
    const bool simulated = study_.store.commitment().simulated;
    const std::string task = "task-" + task_;
    files_.push_back(text_file(task + "_channels.tsv", tsv_text(motion_channels())));
    files_.push_back(text_file(task + "_channels.json", channels_json()));
    files_.push_back(text_file("scans.json", columns_json({"filename", "acq_time"}, simulated)));
  }

  void add(const BidsSession& session) {
    const std::string trials = "beh/" + session.stem() + "_task-" + task_ + "_beh.tsv";
    DataTable scans{{"filename", "acq_time"}, {{trials, shifted_time(session, {})}}};
    for (const TrialOutcome& trial : study_.outcomes->trials) {
      if (trial.row.session != session.row.session || !trial.row.has_trace()) continue;
      const nanoseconds at = add_run(session, trial);
      scans.rows.push_back(
          {motion_file(session, task_, trial.row.trial), shifted_time(session, at)});
    }
    std::ranges::stable_sort(scans.rows, {},
                             [](const auto& cells) { return std::get<std::string>(cells[1]); });
    files_.push_back(
        text_file(session.folder() + "/" + session.stem() + "_scans.tsv", tsv_text(scans)));
  }

  [[nodiscard]] std::vector<ExportFile> release() { return std::move(files_); }

 private:
  /// \return the time of the run's first sample
  nanoseconds add_run(const BidsSession& session, const TrialOutcome& trial) {
    const record::TrialRow& row = trial.row;
    const TraceEvents& run_events = events_.at({row.session, row.trial});
    const Recording recording = recording_of(row, run_events.body);
    const std::string path = session.folder() + "/" + motion_file(session, task_, row.trial);
    const std::string run = path.substr(0, path.size() - std::string_view("motion.tsv").size());
    files_.push_back({path,
                      [study = study_, row, recording, shared = shared_](const auto& to) {
                        const record::Trace trace = read_trace(study, row, *shared);
                        write_output(to, motion_text(trace, recording));
                      },
                      true});
    files_.push_back(
        text_file(run + "motion.json", motion_json(study_, options_, session, run_events.body)));
    const DataTable events = motion_events(recording, run_events, row, texture_of(study_, trial));
    files_.push_back(text_file(run + "events.tsv", tsv_text(events)));
    return recording.first_sample;
  }

  const DatasetSource& study_;
  const DatasetOptions& options_;
  const std::string& task_;
  std::shared_ptr<SharedReading> shared_;
  std::map<record::TrialId, TraceEvents> events_;
  std::vector<ExportFile> files_;
};

}  // namespace

Recording recording_of(const record::TrialRow& row, const record::TraceBody& body) {
  Recording recording;
  recording.rate_hz = row.rate_hz;
  recording.samples = body.explorations;
  if (recording.samples.empty()) recording.samples = {row.samples};
  recording.starts.resize(recording.samples.size());
  recording.starts.front() = nanoseconds{};
  recording.first_sample = row.presented_at;
  if (body.began_ns.empty()) return recording;
  recording.first_sample += nanoseconds(body.began_ns.front());
  for (std::size_t i = 0; i < std::min(recording.starts.size(), body.began_ns.size()); ++i) {
    recording.starts[i] = nanoseconds(body.began_ns[i] - body.began_ns.front());
  }
  return recording;
}

DataTable motion_channels() {
  const std::monostate missing;
  const std::string hand = "hand";
  const std::string stylus = "stylus";
  const std::string plane = "plane";
  const auto position_channel = [&](const char* axis,
                                    const char* description) -> std::vector<DataCell> {
    return {axis, axis, "POS", stylus, "mm", hand, plane, description};
  };
  const auto force_channel = [&](const char* name, const char* axis,
                                 const char* description) -> std::vector<DataCell> {
    return {name, axis, "MISC", stylus, "N", hand, plane, description};
  };
  return {{"name", "component", "type", "tracked_point", "units", "placement", "reference_frame",
           "description"},
          {{"latency", missing, "LATENCY", missing, "s", missing, missing,
            "Time since the run's first sample"},
           position_channel("x", "Position of the stylus along the texture, from its left edge"),
           position_channel("y", "Position of the stylus along the texture, from its top edge"),
           position_channel("z", "Height of the stylus above the plane; negative: pressed into it"),
           force_channel("force_x", "x", "Force sent to the device along x"),
           force_channel("force_y", "y", "Force sent to the device along y"),
           force_channel("force_z", "z", "Force sent to the device out of the plane")}};
}

std::string motion_text(const record::Trace& trace, const Recording& recording) {
  std::string text;
  text.reserve(trace.samples.size() * 60);
  auto sample = trace.samples.begin();
  for (std::size_t i = 0; i < recording.samples.size(); ++i) {
    for (std::int64_t k = 0; k < recording.samples[i] && sample != trace.samples.end(); ++k) {
      if (recording.starts[i]) {
        const nanoseconds time = *recording.starts[i] + duration_of(k, recording.rate_hz);
        put_fixed<6>(text, std::chrono::round<std::chrono::microseconds>(time).count(), '\t');
      } else {
        text += "n/a\t";
      }
      put_sample(text, *sample++);
    }
  }
  return text;
}

std::string motion_file(const BidsSession& session, const std::string& task, int trial) {
  return fmt::format("motion/{}_task-{}_tracksys-stylus_run-{:03}_motion.tsv", session.stem(), task,
                     trial);
}

const std::vector<std::string>& motion_event_columns() {
  static const std::vector<std::string> kColumns{"onset", "duration", "trial_type", "incident",
                                                 "exploration"};
  return kColumns;
}

std::vector<ExportFile> motion_files(const DatasetSource& study, const DatasetOptions& options,
                                     const std::vector<BidsSession>& sessions,
                                     const std::string& task) {
  MotionFiles files(study, options, task);
  files.add_common();
  for (const BidsSession& session : sessions) files.add(session);
  return files.release();
}

}  // namespace touchtrial::analysis
