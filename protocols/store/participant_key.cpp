#include "protocols/store/contexts.hpp"
#include "protocols/store/study_store.hpp"

#include <algorithm>

namespace touchtrial::store {
namespace {

constexpr std::size_t kWrapPadding = 64;

SecretKey wrapping_key(const SecretKey& study_master) {
  return derive_key(study_master, "participant keys");
}

}  // namespace

Bytes wrap_participant_key(const SecretKey& study_master, int own_session,
                           const SecretKey& participant_key) {
  return seal(wrapping_key(study_master), participant_key_context(own_session), participant_key,
              kWrapPadding);
}

std::optional<SecretKey> unwrap_participant_key(const SecretKey& study_master, int own_session,
                                                const Bytes& wrapped) {
  const std::optional<Bytes> bytes = unseal(
      wrapping_key(study_master), participant_key_context(own_session), wrapped, kWrapPadding);
  SecretKey key{};
  if (!bytes || bytes->size() != key.size()) return std::nullopt;
  std::copy(bytes->begin(), bytes->end(), key.begin());
  return key;
}

std::optional<std::string> unsealed(const Event& event, const SecretKey& participant_key) {
  const std::string context = event_context(event.own_session(), event.sequence, event.kind);
  const std::optional<Bytes> bytes = unseal(participant_key, context, event.sealed);
  if (!bytes) return std::nullopt;
  return text_of(*bytes);
}

std::optional<Trace> unsealed_trace(int own_session, int trial, const Bytes& box,
                                    const SecretKey& participant_key, std::size_t sample_count) {
  const std::optional<Bytes> bytes =
      unseal(participant_key, trace_context(own_session, trial), box, trace_padding(sample_count));
  if (!bytes) return std::nullopt;
  return decode_trace(*bytes);
}

std::optional<Trace> unsealed_trace(const SealedTrace& sealed, const SecretKey& participant_key,
                                    std::size_t sample_count) {
  return unsealed_trace(sealed.session, sealed.trial, sealed.box, participant_key, sample_count);
}

}  // namespace touchtrial::store
