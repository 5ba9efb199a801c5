#include "record/trace.hpp"

#include "core/errors.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <zstd.h>
#include <zstd_errors.h>

namespace touchtrial::record {
namespace {

constexpr std::array<std::uint8_t, 4> kTraceMagic = {'T', 'T', 'R', '1'};
constexpr std::size_t kHeaderSize =
    kTraceMagic.size() + sizeof(std::uint64_t) + sizeof(std::uint32_t);
constexpr std::size_t kMaxSamples = 10'000'000;
constexpr unsigned kMaxPlanes = 4;

/// One of the six numbers of a sample, and its quantisation.
struct Channel {
  Vec3 TraceSample::*vector;
  double Vec3::*component;
  double steps_per_unit;
  double limit;     ///< largest magnitude, in units
  int differences;  ///< order of the stored differences, 1 or 2
};

// Motion is smooth, so its second differences are small. Forces contain the texture's vibration,
// whose second differences would be larger than its first.
constexpr double kPositionStepsPerMm = 1000.0;
constexpr double kForceStepsPerN = 4096.0;
constexpr std::array<Channel, 6> kChannels = {{
    {&TraceSample::position_mm, &Vec3::x, kPositionStepsPerMm, 10'000.0, 2},
    {&TraceSample::position_mm, &Vec3::y, kPositionStepsPerMm, 10'000.0, 2},
    {&TraceSample::position_mm, &Vec3::z, kPositionStepsPerMm, 10'000.0, 2},
    {&TraceSample::force_n, &Vec3::x, kForceStepsPerN, 100.0, 1},
    {&TraceSample::force_n, &Vec3::y, kForceStepsPerN, 100.0, 1},
    {&TraceSample::force_n, &Vec3::z, kForceStepsPerN, 100.0, 1},
}};

[[noreturn]] void refuse_bytes(const char* reason) {
  throw StoreError(std::string("trace: ") + reason +
                   "; the database is damaged or has another version, restore it from a backup");
}

constexpr std::size_t kNumbers = kChannels.size();

/// Whether the memory order of a sample's numbers is the order of channels.
constexpr bool is_in_order() {
  const TraceSample sample{{0.0, 1.0, 2.0}, {3.0, 4.0, 5.0}};
  for (std::size_t c = 0; c < kNumbers; ++c) {
    if (sample.*kChannels[c].vector.*kChannels[c].component != static_cast<double>(c)) return false;
  }
  return true;
}

/// Two numbers side by side in a register.
using Pair = double __attribute__((vector_size(2 * sizeof(double))));
using PairOfSteps = std::int32_t __attribute__((vector_size(2 * sizeof(std::int32_t))));

/// Uninitialised memory, which is written before it is read.
template <typename Number>
class Buffer {
 public:
  explicit Buffer(std::size_t size)
      : numbers_(std::make_unique_for_overwrite<Number[]>(size)), size_(size) {}
  [[nodiscard]] std::span<Number> span() const noexcept { return {numbers_.get(), size_}; }

 private:
  std::unique_ptr<Number[]> numbers_;
  std::size_t size_;
};

/// Quantises samples into whole steps, one channel after the other. The limits keep second
/// differences within 32 bits.
Buffer<std::int32_t> quantise(std::span<const TraceSample> samples) {
  // A sample consists of its channels' numbers, in the order of the channels.
  static_assert(sizeof(TraceSample) == kNumbers * sizeof(double));
  static_assert(is_in_order());
  // Adding and subtracting it rounds to whole numbers, halves to even.
  constexpr double kRounding = 0x1.8p52;
  const std::size_t count = samples.size();
  Buffer<std::int32_t> steps(kNumbers * count);
  bool all_inside = true;
  for (std::size_t c = 0; c < kNumbers; c += 2) {
    const Pair scale = {kChannels[c].steps_per_unit, kChannels[c + 1].steps_per_unit};
    const Pair limit = {kChannels[c].limit, kChannels[c + 1].limit};
    std::int32_t* const first = steps.span().data() + c * count;
    auto fits = limit == limit;
    for (std::size_t i = 0; i < count; ++i) {
      Pair value;
      std::memcpy(&value, reinterpret_cast<const char*>(&samples[i]) + c * sizeof(double),
                  sizeof value);
      const auto is_inside = (value <= limit) & (value >= -limit);  // false for NaN
      fits &= is_inside;
      value = is_inside ? value * scale : Pair{};
      const PairOfSteps rounded =
          __builtin_convertvector((value + kRounding) - kRounding, PairOfSteps);
      first[i] = rounded[0];
      first[count + i] = rounded[1];
    }
    all_inside = all_inside && fits[0] != 0 && fits[1] != 0;
  }
  if (!all_inside) {
    throw StoreError(
        "trace: a sample is not finite or exceeds 10 m or 100 N; check the device's units");
  }
  return steps;
}

/// Maps small numbers of either sign to small non-negative ones.
std::uint32_t zigzag(std::int32_t step) {
  return (std::bit_cast<std::uint32_t>(step) << 1U) ^ std::bit_cast<std::uint32_t>(step >> 31);
}
std::int32_t unzigzag(std::uint32_t code) {
  return std::bit_cast<std::int32_t>((code >> 1U) ^ (0U - (code & 1U)));
}

template <typename Unsigned>
void put(Bytes& bytes, Unsigned number) {
  for (std::size_t i = 0; i < sizeof number; ++i) {
    bytes.push_back(static_cast<std::uint8_t>(number >> (8U * i)));
  }
}

/// Reads bytes from the front, never beyond the end.
class Cursor {
 public:
  explicit Cursor(ByteView bytes) : remaining_(bytes) {}

  [[nodiscard]] ByteView take(std::size_t count) {
    if (count > remaining_.size()) refuse_bytes("it is truncated");
    const ByteView bytes = remaining_.first(count);
    remaining_ = remaining_.subspan(count);
    return bytes;
  }
  template <typename Unsigned>
  [[nodiscard]] Unsigned number() {
    Unsigned value = 0;
    unsigned shift = 0;
    for (const std::uint8_t byte : take(sizeof value)) {
      value |= static_cast<Unsigned>(Unsigned{byte} << shift);
      shift += 8;
    }
    return value;
  }
  [[nodiscard]] bool at_end() const { return remaining_.empty(); }

 private:
  ByteView remaining_;
};

struct FreeCompressor {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
};
using Compressor = std::unique_ptr<ZSTD_CCtx, FreeCompressor>;

[[noreturn]] void refuse_to_compress(std::size_t code) {
  throw StoreError(std::string("trace: zstd cannot compress it (") + ZSTD_getErrorName(code) +
                   "); free some memory");
}

/// Makes a compressor of level 1 that searches only for long matches, in a small table. In a plane
/// of differences only runs of zeros repeat, and the entropy coder handles the rest. This halves
/// the time at equal size.
Compressor make_compressor() {
  Compressor compressor(ZSTD_createCCtx());
  if (!compressor) throw std::bad_alloc();
  constexpr std::array<std::pair<ZSTD_cParameter, int>, 3> kParameters = {
      {{ZSTD_c_compressionLevel, 1}, {ZSTD_c_minMatch, 7}, {ZSTD_c_hashLog, 6}}};
  for (const auto& [parameter, value] : kParameters) {
    const std::size_t code = ZSTD_CCtx_setParameter(compressor.get(), parameter, value);
    if (ZSTD_isError(code) != 0) refuse_to_compress(code);
  }
  return compressor;
}

/// The buffers for packing a trace's channels, one after the other.
struct PackingBuffers {
  explicit PackingBuffers(std::size_t count)
      : codes(count), plane(count), frame(ZSTD_compressBound(count)) {}

  Compressor compressor = make_compressor();
  Buffer<std::uint32_t> codes;
  Buffer<std::uint8_t> plane;
  Buffer<std::uint8_t> frame;
};

void put_compressed(Bytes& bytes, PackingBuffers& buffers) {
  const std::span frame = buffers.frame.span();
  const std::span plane = buffers.plane.span();
  const std::size_t size = ZSTD_compress2(buffers.compressor.get(), frame.data(), frame.size(),
                                          plane.data(), plane.size());
  if (ZSTD_isError(size) != 0) refuse_to_compress(size);
  put(bytes, static_cast<std::uint32_t>(size));
  bytes.insert(bytes.end(), frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(size));
}

/// Zigzag codes of a channel's differences. The first number and the first slope are not small, so
/// they are stored unchanged.
void take_differences(std::span<const std::int32_t> steps, int differences,
                      std::span<std::uint32_t> codes) {
  const std::size_t count = steps.size();
  if (count > 0) codes[0] = zigzag(steps[0]);
  if (count > 1) codes[1] = zigzag(steps[1] - steps[0]);
  if (differences == 1) {
    for (std::size_t i = 2; i < count; ++i) codes[i] = zigzag(steps[i] - steps[i - 1]);
  } else {
    for (std::size_t i = 2; i < count; ++i) {
      codes[i] = zigzag((steps[i] - steps[i - 1]) - (steps[i - 1] - steps[i - 2]));
    }
  }
}

/// Writes the lowest bytes of all codes as one plane, then the next bytes, up to the highest byte
/// of the largest code. Each plane has its own statistics and therefore gets its own code table.
void put_channel(Bytes& bytes, PackingBuffers& buffers) {
  const std::span codes = buffers.codes.span();
  std::uint32_t all_bits = 0;
  for (const std::uint32_t code : codes) all_bits |= code;
  const auto planes = static_cast<unsigned>((std::bit_width(all_bits) + 7) / 8);
  bytes.push_back(static_cast<std::uint8_t>(planes));
  for (unsigned p = 0; p < planes; ++p) {
    std::transform(codes.begin(), codes.end(), buffers.plane.span().begin(),
                   [p](std::uint32_t code) { return static_cast<std::uint8_t>(code >> (8U * p)); });
    put_compressed(bytes, buffers);
  }
}

unsigned read_plane_count(Cursor& cursor) {
  const unsigned planes = cursor.number<std::uint8_t>();
  if (planes > kMaxPlanes) refuse_bytes("a channel has too many bytes per number");
  return planes;
}

ByteView read_frame(Cursor& cursor) {
  return cursor.take(cursor.number<std::uint32_t>());
}

/// Checks the parts' lengths before memory is allocated for the stated number of samples.
void require_consistent(Cursor cursor, std::size_t count) {
  for (std::size_t channel = 0; channel < kChannels.size(); ++channel) {
    const unsigned planes = read_plane_count(cursor);
    for (unsigned p = 0; p < planes; ++p) {
      const ByteView frame = read_frame(cursor);
      if (ZSTD_getFrameContentSize(frame.data(), frame.size()) != count) {
        refuse_bytes("a part's length differs from the number of samples");
      }
    }
  }
  if (!cursor.at_end()) refuse_bytes("it has bytes after its last part");
}

void read_plane(Cursor& cursor, Bytes& plane) {
  const ByteView frame = read_frame(cursor);
  const std::size_t size = ZSTD_decompress(plane.data(), plane.size(), frame.data(), frame.size());
  if (ZSTD_getErrorCode(size) == ZSTD_error_memory_allocation) throw std::bad_alloc();
  if (ZSTD_isError(size) != 0 || size != plane.size()) refuse_bytes("a part does not decompress");
}

/// Reads the channel's differences, as zigzag codes.
std::vector<std::uint32_t> read_codes(Cursor& cursor, std::size_t count) {
  const unsigned planes = read_plane_count(cursor);
  std::vector<std::uint32_t> codes(count, 0);
  Bytes plane(count);
  for (unsigned p = 0; p < planes; ++p) {
    read_plane(cursor, plane);
    for (std::size_t i = 0; i < count; ++i) codes[i] |= std::uint32_t{plane[i]} << (8U * p);
  }
  return codes;
}

void restore_channel(const Channel& channel, std::span<const std::uint32_t> codes,
                     std::span<TraceSample> samples) {
  const auto limit = static_cast<std::int64_t>(channel.limit * channel.steps_per_unit);
  std::int64_t step = 0;
  std::int64_t slope = 0;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const std::int64_t code = unzigzag(codes[i]);
    // The first code is the sample itself; second differences start at the third sample.
    slope = channel.differences == 2 && i > 1 ? slope + code : code;
    step += slope;
    if (step < -limit || step > limit) refuse_bytes("a sample exceeds 10 m or 100 N");
    (samples[i].*channel.vector).*channel.component =
        static_cast<double>(step) / channel.steps_per_unit;
  }
}

}  // namespace

Bytes encode_trace(const Trace& trace) {
  if (trace.samples.size() > kMaxSamples) {
    throw StoreError("trace: more than 10,000,000 samples; shorten trials.explore_limit_s");
  }
  if (!std::isfinite(trace.rate_hz) || trace.rate_hz <= 0.0) {
    throw StoreError("trace: the sampling rate is not a positive number; check the device");
  }
  Bytes bytes(kTraceMagic.begin(), kTraceMagic.end());
  bytes.reserve(kHeaderSize + 8 * trace.samples.size() + 4096);
  put(bytes, std::bit_cast<std::uint64_t>(trace.rate_hz));
  put(bytes, static_cast<std::uint32_t>(trace.samples.size()));
  const std::size_t count = trace.samples.size();
  const Buffer<std::int32_t> steps = quantise(trace.samples);
  PackingBuffers buffers(count);
  for (std::size_t c = 0; c < kNumbers; ++c) {
    take_differences(steps.span().subspan(c * count, count), kChannels[c].differences,
                     buffers.codes.span());
    put_channel(bytes, buffers);
  }
  return bytes;
}

Trace decode_trace(ByteView bytes) {
  Cursor cursor(bytes);
  const ByteView magic = cursor.take(kTraceMagic.size());
  if (!std::equal(magic.begin(), magic.end(), kTraceMagic.begin()))
    refuse_bytes("its magic number is missing");
  Trace trace;
  trace.rate_hz = std::bit_cast<double>(cursor.number<std::uint64_t>());
  if (!std::isfinite(trace.rate_hz) || trace.rate_hz <= 0.0)
    refuse_bytes("its rate is not positive");
  const std::size_t count = cursor.number<std::uint32_t>();
  if (count > kMaxSamples) refuse_bytes("it states more than 10,000,000 samples");
  require_consistent(cursor, count);
  trace.samples.resize(count);
  for (const Channel& channel : kChannels) {
    restore_channel(channel, read_codes(cursor, count), trace.samples);
  }
  return trace;
}

std::size_t trace_padding(std::size_t sample_count) {
  constexpr std::size_t kBytesPerStep = 2048 + 8 * kPaddingStep;
  const std::size_t count = std::clamp(sample_count, std::size_t{1}, kMaxSamples);
  return kBytesPerStep * ((count + kPaddingStep - 1) / kPaddingStep);
}

}  // namespace touchtrial::record
