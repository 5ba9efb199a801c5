/// \file Who looked at outcomes, and when: every unblinding that the file's chain holds.
#pragma once

#include "record/study_store.hpp"
#include "study/study_key.hpp"

#include <chrono>
#include <set>
#include <string>
#include <vector>

namespace touchtrial::analysis {

enum class LookKind {
  final,         ///< after the study was closed
  registered,    ///< at the registered question alone, at a registered number of participants
  unregistered,  ///< any other interim look
  person,        ///< at the outcomes of one participant
};

/// "final", "registered", "unregistered", "one participant"
[[nodiscard]] std::string name_of(LookKind kind);

struct Look {
  std::chrono::nanoseconds at{};  ///< UTC since 1970
  int participants = 0;           ///< whose sessions were complete and counted at that time
  std::string reason;
  LookKind kind = LookKind::final;
  std::string participant{};  ///< of LookKind::person
  int station = 0;            ///< of a collected study: whose look it was, from 1; 0: at the whole

  /// Of LookKind::person: looks at two participants or more, before the study was closed, tell how
  /// it goes.
  bool is_one_of_several = false;

  /// Whether it could have decided when collecting ends, without having been registered. A look at
  /// one participant alone tells too little of the study for that.
  [[nodiscard]] bool is_unregistered() const noexcept {
    return kind == LookKind::unregistered || is_one_of_several;
  }
};

/// How a study's outcomes were looked at, and which sessions were left out with knowledge of them.
struct LookRecord {
  std::vector<Look> looks;            ///< in the order of the chain, those at stations first
  std::set<int> excluded_afterwards;  ///< sessions excluded after a look at their outcomes
  std::set<int> replaced_afterwards;  ///< likewise replaced
  std::set<int> erased_afterwards;    ///< likewise erased at the participant's wish
  int participants = 0;               ///< whose sessions are complete and counted today
  bool may_look = false;              ///< an interim look today would be a registered one
};

/// Reads the looks from the file's chain and from those of collected stations.
/// \param key  has the looks that were registered. A study of several stations can make none of
///   them: a look at a merged file is not in the next merge
/// \throws StoreError if a body cannot be read
[[nodiscard]] LookRecord look_record(const record::StudyStore& store, const study::StudyKey& key);

}  // namespace touchtrial::analysis
