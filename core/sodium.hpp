/// \file libsodium, ready to use. Private to this folder.
#pragma once

namespace touchtrial {

/// Lets libsodium choose its fastest implementations for this processor; until then it uses
/// portable ones, which give the same bytes. Every function of this folder that calls libsodium
/// calls it first. Later calls cost nothing; thread-safe.
/// \return whether libsodium works, its random generator included
bool prepare_sodium() noexcept;

}  // namespace touchtrial
