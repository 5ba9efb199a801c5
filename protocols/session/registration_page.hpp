/// \file The page that is deposited before the first participant.
#pragma once

#include "engine/pack/pack.hpp"
#include "protocols/design/study_key.hpp"

#include <string>
#include <vector>

namespace touchtrial::session {

/// Whether key and pack are those of the study as it stands.
/// \param study  read anew from its file
/// \throws UsageError with what differs and the remedy
void require_prepared(const design::Study& study, const design::StudyKey& key,
                      const engine::Pack& pack);

/// Markdown: what the study's registration states, the design, the validity rule, and the hashes
/// that bind study, key and pack. Reveals the classes' labels (sorted), methods, rendering and
/// trials; no image name, code, seed, secret or schedule. The same input gives the same text.
/// \pre require_prepared
[[nodiscard]] std::string registration_page(const design::StudyKey& key, const engine::Pack& pack);

/// What the registration leaves unsaid, as JSON pointers.
[[nodiscard]] std::vector<std::string> unstated(const design::Registration& registration);

}  // namespace touchtrial::session
