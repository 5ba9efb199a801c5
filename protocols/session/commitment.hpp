/// \file The commitment to a study before the first participant: the first event of a database, and
/// the preregistration page with the same hashes.
#pragma once

#include "engine/pack/pack.hpp"
#include "record/file_bodies.hpp"
#include "study/study_key.hpp"

#include <string>
#include <vector>

namespace touchtrial::session {

/// The body of the first event of a study's file chain.
[[nodiscard]] record::StudyCommitment commitment_of(const study::StationKey& key,
                                                    const engine::Pack& pack, bool simulated,
                                                    bool pilot);
/// The same for the key's first station.
[[nodiscard]] record::StudyCommitment commitment_of(const study::StudyKey& key,
                                                    const engine::Pack& pack, bool simulated,
                                                    bool pilot);

/// Checks that key and pack belong to the current version of the study.
/// \param study  as read from its file
/// \param key_file  the file of `key`
/// \throws UsageError with the difference and the remedy
/// \throws FileError as study::require_signed
void require_prepared(const study::Study& study, const study::StudyCodes& key,
                      const std::filesystem::path& key_file, const engine::Pack& pack);

/// The preregistration page as Markdown: the statements of the study's registration, the design,
/// the validity rule, and the hashes that bind study, key and pack. The page reveals the classes'
/// labels (sorted), methods, rendering and trials, but no image name, code, seed, secret or
/// schedule. The same input gives the same text.
/// \pre require_prepared
[[nodiscard]] std::string registration_page(const study::StudyCodes& key, const engine::Pack& pack);

/// The missing parts of a registration, as JSON pointers.
[[nodiscard]] std::vector<std::string> missing_statements(const study::Registration& registration);

}  // namespace touchtrial::session
