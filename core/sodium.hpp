/// \file Initialises libsodium. Private to this folder.
#pragma once

namespace touchtrial {

/// Lets libsodium choose its fastest implementations for this processor; until then it uses
/// portable ones, which give the same bytes. Call it before any function of libsodium. Repeated
/// calls cost nothing. Thread-safe.
/// \return whether libsodium works, its random generator included
bool prepare_sodium() noexcept;

}  // namespace touchtrial
