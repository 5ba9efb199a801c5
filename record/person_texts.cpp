#include "record/person_texts.hpp"

#include "core/cipher.hpp"
#include "record/body_parts.hpp"
#include "record/payload_json.hpp"
#include "record/sealing.hpp"

#include <utility>

namespace touchtrial::record {
namespace {

/// The padding of texts, bytes: a box reveals only the multiple.
constexpr std::size_t kTextPadding = 256;

/// A remark without a code is not a deviation. Everything else is part of the safety record.
bool is_plain_remark(EventKind kind, const std::string& body) {
  return kind == EventKind::participant_noted && from_json<NoteBody>(body).code.empty();
}

/// The context that binds a box to its event. It contains only members that collecting does not
/// change.
std::string context_of(EventKind kind, std::chrono::nanoseconds at, int own_session) {
  return "text|" + std::to_string(own_session) + "|" + std::string(name_of(kind)) + "|" +
         std::to_string(at.count());
}

}  // namespace

PersonText sealed_person_text(EventKind kind, std::chrono::nanoseconds at, const std::string& body,
                              const SessionOpenedBody& opening) {
  BodyParts parts = split_body(kind, body);
  parts.hidden.resize((parts.hidden.size() / kTextPadding + 1) * kTextPadding,
                      ' ');  // trailing blanks are valid JSON
  const int own_session = opening.own_session > 0 ? opening.own_session : opening.session;
  SystemEntropy entropy;
  return {std::move(parts.clear),
          seal_box(is_plain_remark(kind, body) ? opening.remarks : opening.reasons,
                   context_of(kind, at, own_session), bytes_of(parts.hidden),
                   entropy.secret("text about a person"))};
}

const std::optional<SecretKey>& opening_key(const Event& event, const PersonKeys& keys) {
  if (event.session <= 0) {
    return is_plain_remark(event.kind, event.body) ? keys.participant : keys.safety;
  }
  return is_safety_record(event.kind) && !keys.participant ? keys.safety : keys.participant;
}

std::optional<Event> opened_person_text(const Event& event, int own_session,
                                        const PersonKeys& keys) {
  if (event.sealed.empty()) return event;
  const std::optional<SecretKey>& key = opening_key(event, keys);
  if (!key) return std::nullopt;
  const std::optional<Bytes> text =
      open_box(is_plain_remark(event.kind, event.body) ? remarks_box(*key) : reasons_box(*key),
               context_of(event.kind, event.at, own_session), event.sealed);
  if (!text) return std::nullopt;
  Event opened = event;
  opened.body = join_body({event.body, text_of(ByteView(*text))});
  opened.sealed.clear();
  return opened;
}

}  // namespace touchtrial::record
