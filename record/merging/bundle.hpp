/// \file One row of a station on a server, in two halves: a part of the station's file chain, and
/// the session that this part closes, as the station wrote them, compressed with zstd. The content
/// is not trusted: merging checks it like a file. Format: docs/data-dictionary.md, "Bundles".
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
  record::WrappedKeys keys{};                   ///< the session's
  std::vector<std::pair<int, Bytes>> traces{};  ///< likewise, by trial
};

[[nodiscard]] Bytes packed(const BundleHalf& half);

/// Takes time and memory in proportion to kMaxBundleBytes, whatever the bytes are.
/// \param session  the events'; 0: the file's chain
/// \throws StoreError if the bytes were not packed by this program
[[nodiscard]] BundleHalf unpacked(ByteView bytes, int session);

}  // namespace touchtrial::merging
