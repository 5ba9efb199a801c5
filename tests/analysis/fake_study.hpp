/// \file A study whose answers a test chooses, recorded as a real one is.
#pragma once

#include "protocols/identification/study/identification.hpp"
#include "record/study_store.hpp"
#include "study/study_key.hpp"
#include "support/temp_folder.hpp"

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial {

/// Class index of the answer to a presentation, or nothing to let the time run out.
using FakeAnswers = std::function<std::optional<int>(const study::Trial&)>;

/// What was felt in a presentation.
using FakeTraces = std::function<record::Trace(const study::Trial&)>;

/// The course of one fake session.
struct FakeSession {
  std::string participant;
  int enrolment = 1;
  FakeAnswers answers{};  ///< empty: everything right
  bool complete = true;
  bool valid = true;
  bool within_limits = true;                       ///< by the sealed measures
  std::optional<record::StationRecord> station{};  ///< as in real time
  std::optional<record::ServoHealth> servo{};      ///< of every trial
  int interrupt_trial = 0;   ///< interrupted, and presented again at the end; 0: none
  int stop_after = 1 << 20;  ///< presentations
  /// Recorded after the opening, before 10 s have passed.
  std::function<void(record::SessionRecorder&)> before_trials{};
  bool one_key = false;        ///< that the session ends with
  FakeTraces traces{};         ///< empty: a touch too short to feel anything
  record::HandWindows hand{};  ///< of every second trial
  bool ends = true;            ///< false: it is left open after its last presentation
  int visit = 1;
  std::chrono::hours after{};  ///< later on the file's chain than sessions usually are
};

struct FakeOptions {
  bool simulated = true;
  std::string label = "bark";  ///< of the first class
  bool pilot = false;
  std::string trials{};        ///< JSON that changes the study's trials; may be empty
  std::string registration{};  ///< JSON; may be empty
  std::string session{};       ///< JSON; may be empty
  std::string sections{};      ///< JSON that changes or adds sections of the study; may be empty
  bool with_pack = false;      ///< tiny fields in `folder() / "study.pack"`
  /// Divides eight enrolment numbers between stations of these names; the file is the first's.
  std::vector<std::string> stations{};
};

/// Three classes, each with one image, four presentations a method.
class FakeStudy {
 public:
  explicit FakeStudy(const study::Protocol& protocol, const FakeOptions& options = {});
  /// A classification.
  explicit FakeStudy(const FakeOptions& options)
      : FakeStudy(study::identification::classification(), options) {}

  [[nodiscard]] const study::StudyKey& key() const noexcept { return key_; }
  [[nodiscard]] record::StudyStore& store() noexcept { return store_; }
  [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_.path(); }
  [[nodiscard]] std::filesystem::path pack_folder() const { return folder() / "study.pack"; }
  [[nodiscard]] std::filesystem::path database() const { return folder() / "study.db"; }

  void add(const FakeSession& session);
  void close_and_unblind();

  /// Answers everything right.
  [[nodiscard]] static FakeAnswers always_right();
  /// Answers `to` to class `from`, and is right about all others.
  [[nodiscard]] static FakeAnswers confusing(int from, int to);

 private:
  TempFolder folder_;
  study::StudyKey key_;
  record::StudyStore store_;
};

/// A pause, a note, three interruptions of trial 1 and a stop that did not last, with the answers
/// to two questionnaires: the inventory of somebody right-handed, and `closing`.
[[nodiscard]] FakeSession talkative(const std::string& participant, int enrolment,
                                    const std::string& closing);

/// Its study file.
[[nodiscard]] std::string fake_study_text(const study::Protocol& protocol,
                                          const std::string& first_label);

}  // namespace touchtrial
