/// \file The key of a study: what the codes mean, and the study's secrets. `<study>.key`, mode
/// 0600. Format: docs/data-dictionary.md, "Key".
#pragma once

#include "core/cipher.hpp"
#include "protocols/design/schedule.hpp"
#include "protocols/design/study.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::design {

/// One code and its meaning.
struct KeyedStimulus {
  std::string code;
  StimulusIndex stimulus;
};

/// Public identity, secrets, and the study they belong to.
struct StudyKey {
  std::string study_id;  ///< hexadecimal; derived from master, tells nothing of it
  SecretKey master{};
  SecretKey nonce{};
  Study study;                         ///< as sealed: labels, image names, methods, seed
  std::vector<KeyedStimulus> stimuli;  ///< every presented class x exemplar x method
  std::filesystem::path pack_folder;   ///< where the pack lay when the key was written
  bool simulated = false;

  /// \return the meaning, or nothing if no stimulus has this code
  [[nodiscard]] std::optional<StimulusIndex> stimulus_of(const std::string& code) const;
  /// \throws StudyError if the study does not present it
  [[nodiscard]] const std::string& code_of(const StimulusIndex& stimulus) const;
};

/// A new key: secrets from `entropy` (asked for "touchtrial study key master" and "touchtrial study
/// key nonce"), codes derived from them. A code depends on master, label, image path as written and
/// method label alone, so it stays with its stimulus when others come or go.
/// \throws StudyError if two stimuli got one code (2^-64 a pair)
[[nodiscard]] StudyKey make_study_key(const Study& study, Entropy& entropy, bool simulated);

/// The same secrets for a study file that has changed since.
[[nodiscard]] StudyKey rekeyed(const StudyKey& key, const Study& study);

/// Writes durably with mode 0600; the folders of study and pack relative to the key, so that all
/// three can be moved together. \throws FileError
void save_study_key(const std::filesystem::path& path, const StudyKey& key);

/// \throws FileError if the file is missing, malformed or altered since it was written
[[nodiscard]] StudyKey load_study_key(const std::filesystem::path& path);

/// Schedule and layout as the secret part of a session's opening: codes in place of indices.
[[nodiscard]] std::string schedule_to_json(const Schedule& schedule, const StudyKey& key);
/// \throws StoreError if the text is not such, or names a code that the key does not have
[[nodiscard]] Schedule schedule_from_json(const std::string& text, const StudyKey& key);

/// A restarted block as the secret part of its event, in the same form as a schedule's
/// presentations.
[[nodiscard]] std::string block_to_json(const std::vector<Presentation>& block,
                                        const StudyKey& key);
/// \throws StoreError as schedule_from_json
[[nodiscard]] std::vector<Presentation> block_from_json(const std::string& text,
                                                        const StudyKey& key);

/// What stands for the plane without texture where a stimulus has its code: derived from the key as
/// the others are, so that nothing tells it apart from them. No pack has a field of this code.
[[nodiscard]] std::string catch_code(const StudyKey& key);

/// The study with codes in place of labels and image names, sorted by code, without its seed (from
/// which the schedule could be worked out): what a database stores in clear. Of practice, session
/// and registration it has what is no text, and of the texts a keyed hash. Compact JSON.
[[nodiscard]] std::string blinded_configuration(const StudyKey& key);

/// SHA-256 over key (master, and what each code means), schedule rule, seed, blinded configuration
/// and nonce: written before trial 1. Where the study lies and how its file is laid out do not
/// count.
[[nodiscard]] Digest study_seal(const StudyKey& key);

}  // namespace touchtrial::design
