/// \file What participants answered to what they felt: a study after unblinding.
#pragma once

#include "analysis/collection.hpp"
#include "protocols/design/study_key.hpp"
#include "protocols/store/study_store.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// A session, and whether its trials enter accuracy.
struct SessionOutcome {
  store::SessionRow row;
  bool counted = false;
};

/// One trial with its meaning.
struct TrialOutcome {
  std::string participant;
  store::TrialRow row;
  design::StimulusIndex stimulus;  ///< of a catch trial it means nothing
  design::PresentationKind kind = design::PresentationKind::scored;
  bool scored = false;          ///< by the schedule: no practice, no lead-in
  bool counted = false;         ///< enters accuracy
  std::optional<int> response;  ///< index of the choice that was the answer; empty: no response
  std::optional<int> right;     ///< index of the right choice; empty: none is
  std::optional<store::TrialMeasures> measures;

  /// A trial without a response is wrong.
  [[nodiscard]] bool correct() const noexcept { return response && response == right; }
  /// By the whole validity rule: its part in clear and its sealed part.
  [[nodiscard]] bool valid() const noexcept {
    return row.valid && (!measures || measures->within_limits);
  }
};

/// A study's trials with the labels to read them by.
struct Outcomes {
  std::string study;
  bool simulated = false;
  bool pilot = false;
  bool visual = false;  ///< seen on a screen, not felt
  store::StudyState state;
  std::vector<std::string> classes;                 ///< labels
  std::vector<std::vector<std::string>> exemplars;  ///< of each class: image file names
  std::vector<std::string> choices;                 ///< labels of what participants chose between
  std::vector<std::string> methods;                 ///< those that the study presents
  std::vector<SessionOutcome> sessions;             ///< by number, withdrawn ones too
  int sessions_unseen =
      0;  ///< had not ended at an interim look: neither in `sessions` nor `trials`
  std::vector<TrialOutcome> trials;  ///< by session and trial; of withdrawn ones none
  design::Study design;              ///< the study file: by which rule orders were drawn
  Collection collection;
};

/// "session 2, event 7: <what>"
[[nodiscard]] std::string shown(const store::ChainFault& fault);

/// Opens every sealed schedule and measure and holds answers against them.
///
/// A session counts if it was completed and is neither excluded nor withdrawn, and if it is a pilot
/// or simulated session only when the whole study is. Of a counted session's scored trials those
/// count that ended: with an answer, or without a response when time ran out. A trial that was
/// interrupted and repeated keeps its number, and its last presentation with an answer counts; one
/// never repeated does not count. After an interim look only sessions that had ended before it are
/// there, until the next unblinding.
///
/// Before that chains, sealed ends and derived tables are held against the events, but not traces.
///
/// \throws StoreError if the study has not been unblinded
/// \throws VerificationError if the key does not belong, the database does not hold, or a session
/// does not hold against its
///   schedule; the message names the session
[[nodiscard]] Outcomes load_outcomes(const store::StudyStore& store, const design::StudyKey& key);

}  // namespace touchtrial::analysis
