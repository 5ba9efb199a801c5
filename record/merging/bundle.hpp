/// \file One row of a station on a server, in two halves: a part of the station's file chain, and
/// the session that this part closes, compressed with zstd. The content is not trusted: merging
/// checks it like a file. Format: docs/data-dictionary.md, "Bundles".
/// Private to record/merging.
#pragma once

#include "core/bytes.hpp"
#include "record/event.hpp"
#include "record/sealing.hpp"

#include <cstddef>
#include <utility>
#include <vector>

namespace touchtrial::merging {

/// The largest half that is read, before and after compression.
inline constexpr std::size_t kMaxBundleBytes = std::size_t{128} << 20U;

struct BundleHalf {
  std::vector<record::Event> events;            ///< of the chain or the session
  record::WrappedKeys keys{};                   ///< of the session
  std::vector<std::pair<int, Bytes>> traces{};  ///< of the session, by trial
};

[[nodiscard]] Bytes pack_bundle(const BundleHalf& half);

/// Time and memory are limited by kMaxBundleBytes, whatever the bytes are.
/// \param session  the events' session; 0: the file's chain
/// \throws StoreError if the bytes were not packed by this program
[[nodiscard]] BundleHalf unpack_bundle(ByteView bytes, int session);

}  // namespace touchtrial::merging
