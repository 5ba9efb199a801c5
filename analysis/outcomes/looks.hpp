/// \file The looks at outcomes: every unblinding on the file's chain.
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
  registered,    ///< only at the registered question, at a registered number of participants
  unregistered,  ///< any other interim look
  person,        ///< at the outcomes of one participant
};

/// "final", "registered", "unregistered", "one participant"
[[nodiscard]] std::string name_of(LookKind kind);

struct Look {
  std::chrono::nanoseconds at{};  ///< UTC since 1970
  int participants = 0;           ///< with complete sessions that counted at that time
  std::string reason;
  LookKind kind = LookKind::final;
  std::string participant{};  ///< of LookKind::person
  int station =
      0;  ///< of a collected study, the station that looked, from 1; 0: a look at the whole study

  /// Of LookKind::person: two or more participants were looked at before the study was closed,
  /// which shows how the study is going.
  bool is_one_of_several = false;

  /// Whether this unregistered look could have influenced when collection ended. A look at a single
  /// participant reveals too little for that.
  [[nodiscard]] bool is_unregistered() const noexcept {
    return kind == LookKind::unregistered || is_one_of_several;
  }
};

/// The looks at a study's outcomes, and the sessions that were left out after a look.
struct LookRecord {
  std::vector<Look> looks;            ///< in the order of the chain, those at stations first
  std::set<int> excluded_afterwards;  ///< sessions excluded after a look at their outcomes
  std::set<int> replaced_afterwards;  ///< likewise replaced
  std::set<int> erased_afterwards;    ///< likewise erased at the participant's request
  int participants = 0;               ///< with complete sessions that count today
  bool may_look = false;              ///< an interim look now would be a registered one
};

/// Reads the looks from the file's chain and from those of collected stations.
/// \param key  lists the registered looks. A study of several stations cannot make them, because a
///   look at a merged file is lost in the next merge
/// \throws StoreError if a body cannot be read
[[nodiscard]] LookRecord look_record(const record::StudyStore& store, const study::StudyKey& key);

}  // namespace touchtrial::analysis
