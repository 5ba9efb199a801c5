#include "fuzz/entries.hpp"

#include "core/errors.hpp"
#include "device/drivers/falcon/falcon_kinematics.hpp"
#include "device/drivers/falcon/falcon_packet.hpp"
#include "device/drivers/inverse3/service_messages.hpp"
#include "engine/image_file.hpp"
#include "protocols/registration/registration.hpp"
#include "protocols/simulation/subject_model.hpp"
#include "record/head_copy.hpp"
#include "record/trace.hpp"
#include "study/key_protection.hpp"
#include "study/study.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace touchtrial::fuzz {
namespace {

void require(bool holds, const char* law) {
  if (!holds) throw std::logic_error(law);
}

/// Requires that the message of a refusal is one line.
void check_refusal(const Error& error) {
  const std::string text = error.what();
  require(!text.empty() && text.find('\n') == std::string::npos, "a refusal is one line");
}

template <typename Read>
void accept_or_refuse(Read read) {
  try {
    read();
  } catch (const Error& error) {
    check_refusal(error);
  }
}

bool equal(const record::Trace& a, const record::Trace& b) {
  if (a.rate_hz != b.rate_hz || a.samples.size() != b.samples.size()) return false;
  for (std::size_t i = 0; i < a.samples.size(); ++i) {
    if (!(a.samples[i].position_mm == b.samples[i].position_mm)) return false;
    if (!(a.samples[i].force_n == b.samples[i].force_n)) return false;
  }
  return true;
}

/// Whether the bytes announce a long trace. A motionless stylus compresses so well that a few bytes
/// may validly stand for millions of samples, which is slow but not wrong. The count follows the
/// magic number and the rate.
bool claims_a_long_trace(ByteView bytes) {
  constexpr std::size_t kCountAt = 12;
  constexpr std::uint32_t kLong = 20'000;
  constexpr std::uint32_t kRefused = 10'000'000;
  if (bytes.size() < kCountAt + 4) return false;
  std::uint32_t count = 0;
  for (std::size_t i = 4; i-- > 0;) count = count << 8U | bytes[kCountAt + i];
  return count > kLong && count <= kRefused;
}

/// Signs heads, so that fuzzed texts pass the signature check.
const Signer& fuzzing_signer() {
  static const Signer signer(sha256(bytes_of("fuzz")));
  return signer;
}

/// A record that was read is written, and read again.
void check_head(const record::HeadRecord& record) {
  const std::vector<PublicKey> signers = {fuzzing_signer().public_half()};
  const std::string copy = record::head_copy_of(record, fuzzing_signer(), "study.db.head");
  require(record::read_head_copy(copy, signers).record == record, "a head survives being stored");
}

/// Adds a bulk transfer without the FTDI's status bytes.
void add_payload(ByteView transfer, std::vector<std::uint8_t>& payload) {
  for (std::size_t at = 0; at < transfer.size(); ++at) {
    if (at % device::falcon::kUsbPacketSize >= device::falcon::kFtdiStatusSize)
      payload.push_back(transfer[at]);
  }
}

/// Counts replies at every position, not only at those that the stream reads.
std::uint64_t replies_in(ByteView payload) {
  std::uint64_t found = 0;
  for (std::size_t at = 0; at + device::falcon::kPacketSize <= payload.size(); ++at) {
    if (device::falcon::decode_reply(payload.subspan(at).first<device::falcon::kPacketSize>()))
      ++found;
  }
  return found;
}

/// Requires a finite pose for any counts, and torques only for reachable poses.
void check_pose(const device::falcon::Reply& reply) {
  const device::falcon::Pose pose =
      device::falcon::forward_kinematics(device::falcon::theta1_of_counts(reply.counts));
  require(is_finite(pose.native_m), "a pose is finite");
  const auto torques = device::falcon::torques_nm(pose.jacobian, {8.0, -8.0, 8.0});
  const bool holds = pose.status == device::falcon::PoseStatus::ok;
  require(torques.has_value() == holds, "torques belong to poses that can be held");
}

}  // namespace

void read_as_image(ByteView bytes) {
  accept_or_refuse([&] {
    const engine::Picture picture = engine::decode_picture(bytes, "picture");
    const GreyImage& image = picture.grey;
    require(!image.empty(), "a picture has pixels");
    require(static_cast<std::int64_t>(image.size()) <= engine::kMaxImagePixels,
            "a picture is not huge");
    if (picture.notes.transparent_share == 0.0) return;
    const GreyImage opacity = engine::opacity_of(bytes, "picture");
    require(std::ranges::count(opacity.samples(), 0) > 0, "a transparent pixel is known");
  });
}

void read_as_study(ByteView bytes) {
  registration::register_protocols();
  accept_or_refuse([&] {
    const study::Study study = study::parse_study(text_of(bytes), "folder", "study.json");
    require(!study.classes.empty() && !study.methods.empty(), "a study has classes and methods");
    require(study.scored_trials() > 0, "a study has trials");
  });
}

void read_as_subject(ByteView bytes) {
  accept_or_refuse([&] {
    const simulation::SubjectModel model =
        simulation::parse_subject_model(text_of(bytes), "subject.json");
    require(model.feature_noise >= 0.0 && model.explore_s > 0.0,
            "a subject's numbers are in range");
  });
}

void read_as_trace(ByteView bytes) {
  if (claims_a_long_trace(bytes)) return;
  accept_or_refuse([&] {
    const record::Trace trace = record::decode_trace(bytes);
    require(equal(record::decode_trace(record::encode_trace(trace)), trace),
            "a trace survives being stored");
  });
}

void read_as_head(ByteView bytes) {
  const std::vector<PublicKey> signers = {fuzzing_signer().public_half()};
  const record::HeadCopy copy = record::read_head_copy(text_of(bytes), signers);
  require(copy.record.has_value() == copy.fault.empty(), "a copy has a record or a fault");
  accept_or_refuse([&] {
    if (copy.record) check_head(*copy.record);
  });
  accept_or_refuse([&] { check_head(record::head_record_from(text_of(bytes), "its text")); });
}

void read_as_protected(ByteView bytes) {
  accept_or_refuse([&] {
    const std::string text = text_of(bytes);
    const auto signer = study::unencrypted_signer(text, "study.key");
    if (!signer) return;
    require(text.find("\nsigns " + to_hex(ByteView(*signer)) + "\n") != std::string::npos,
            "a protected file names who signs with it");
  });
}

void read_as_falcon(ByteView bytes) {
  device::falcon::FalconStream stream;
  std::vector<std::uint8_t> payload;
  while (!bytes.empty()) {
    const std::size_t size = std::min<std::size_t>(bytes[0], bytes.size() - 1);
    const ByteView transfer = bytes.subspan(1, size);
    add_payload(transfer, payload);
    if (stream.push_transfer(transfer) > 0) check_pose(stream.newest());
    bytes = bytes.subspan(1 + size);
  }
  require(stream.replies() == replies_in(payload), "a stream finds every reply and no other");
  require(
      stream.discarded_bytes() + stream.replies() * device::falcon::kPacketSize <= payload.size(),
      "no byte belongs to two things");
}

void read_as_inverse3(ByteView bytes) {
  namespace service = device::inverse3;
  const std::string text(bytes.begin(), bytes.end());
  const auto accept_or_call_bad = [&](auto read) {
    try {
      read();
    } catch (const service::BadMessage&) {
      // As documented.
    }
  };
  accept_or_call_bad([&] {
    for (const service::DeviceReport& report : service::parse_report(text).devices) {
      require(is_finite(report.position_m) && is_finite(report.velocity_m_s) &&
                  is_finite(report.delivered_n.value_or(Vec3{})),
              "an accepted state is finite");
      require(!report.id.empty(), "a device has a name");
    }
  });
  accept_or_call_bad([&] { static_cast<void>(service::parse_version(text)); });
  accept_or_call_bad([&] { static_cast<void>(service::parse_sessions(text)); });
  accept_or_call_bad(
      [&] { require(!service::parse_event(text).name.empty(), "an event has a name"); });
}

}  // namespace touchtrial::fuzz
