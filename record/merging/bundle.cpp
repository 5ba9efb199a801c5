#include "record/merging/bundle.hpp"

#include "core/errors.hpp"
#include "record/damage.hpp"

#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>

#include <zstd.h>

namespace touchtrial::merging {
namespace {

constexpr std::string_view kMagic = "touchtrial bundle 1";
static_assert(std::endian::native == std::endian::little);

/// Writes little-endian numbers of eight bytes, and byte strings after their lengths.
class BundleWriter {
 public:
  BundleWriter() { part(bytes_of(kMagic)); }

  void number(std::int64_t number) { raw({reinterpret_cast<const std::uint8_t*>(&number), 8}); }
  void part(ByteView bytes) {
    number(std::ssize(bytes));
    raw(bytes);
  }
  void event(const record::Event& event) {
    number(event.sequence);
    part(bytes_of(record::name_of(event.kind)));
    number(event.at.count());
    part(bytes_of(event.body));
    part(event.sealed);
    part(event.previous);
    part(event.hash);
    part(event.signature);
  }
  [[nodiscard]] Bytes compressed() const {
    Bytes frame(ZSTD_compressBound(bytes_.size()));
    frame.resize(ZSTD_compress(frame.data(), frame.size(), bytes_.data(), bytes_.size(), 3));
    return frame;
  }

 private:
  void raw(ByteView bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }
  Bytes bytes_;
};

[[noreturn]] void refuse_bytes() {
  throw StoreError("is not a bundle of this version of Touchtrial");
}

class BundleReader {
 public:
  /// Checks the size in a frame before it allocates memory.
  explicit BundleReader(ByteView frame) {
    const unsigned long long size = ZSTD_getFrameContentSize(frame.data(), frame.size());
    if (size > kMaxBundleBytes) refuse_bytes();  // error codes are larger, too
    content_.resize(size);
    if (ZSTD_decompress(content_.data(), size, frame.data(), frame.size()) != size) refuse_bytes();
    remaining_ = content_;
    if (text_of(part()) != kMagic) refuse_bytes();
  }

  [[nodiscard]] bool at_end() const { return remaining_.empty(); }
  [[nodiscard]] std::int64_t number() {
    std::int64_t number = 0;
    std::memcpy(&number, next(sizeof number).data(), sizeof number);
    return number;
  }
  [[nodiscard]] Bytes part() {
    const ByteView bytes = next(static_cast<std::uint64_t>(number()));
    return {bytes.begin(), bytes.end()};
  }
  [[nodiscard]] record::Event event(int session) {
    record::Event event;
    event.session = session;
    event.sequence = number();
    event.kind = record::stored_kind(text_of(part()), session, event.sequence);
    event.at = std::chrono::nanoseconds(number());
    event.body = text_of(part());
    event.sealed = part();
    event.previous = record::stored_hash(part(), session, event.sequence);
    event.hash = record::stored_hash(part(), session, event.sequence);
    event.signature = part();
    return event;
  }

 private:
  ByteView next(std::uint64_t size) {
    if (size > remaining_.size()) refuse_bytes();
    const ByteView bytes = remaining_.first(size);
    remaining_ = remaining_.subspan(size);
    return bytes;
  }
  Bytes content_;
  ByteView remaining_;
};

}  // namespace

Bytes pack_bundle(const BundleHalf& half) {
  BundleWriter writer;
  // An empty part stands for a missing key, because no key is empty.
  writer.part(half.keys.participant.value_or(Bytes()));
  writer.part(half.keys.safety.value_or(Bytes()));
  writer.number(std::ssize(half.events));
  for (const record::Event& event : half.events) writer.event(event);
  for (const auto& [trial, box] : half.traces) {
    writer.number(trial);
    writer.part(box);
  }
  return writer.compressed();
}

BundleHalf unpack_bundle(ByteView bytes, int session) {
  BundleReader reader(bytes);
  BundleHalf half;
  for (std::optional<Bytes>* const key : {&half.keys.participant, &half.keys.safety}) {
    if (Bytes part = reader.part(); !part.empty()) *key = std::move(part);
  }
  for (std::int64_t left = reader.number(); left > 0; --left) {
    half.events.push_back(reader.event(session));
  }
  while (!reader.at_end()) {
    const auto trial = static_cast<int>(reader.number());
    half.traces.emplace_back(trial, reader.part());
  }
  return half;
}

}  // namespace touchtrial::merging
