// A stand-in for liblsl, written from its public header (liblsl 1.16, include/lsl/*.h): outlets
// copy the description that they are made of; a sample has at least as many values as channels; a
// push of the wrong type is an error (-2, lsl_argument_error); the clock counts seconds.
#include "device/fakes/fake_lsl.hpp"

#include <chrono>
#include <cstdint>
#include <list>

using touchtrial::fakes::FakeLsl;
using touchtrial::fakes::FakeLslStream;

namespace {

FakeLsl* const kState = new FakeLsl;  // never freed: the program keeps the library loaded
std::list<FakeLslStream>* const kInfos = new std::list<FakeLslStream>;

constexpr int kDouble64 = 2;
constexpr int kString = 3;
constexpr std::int32_t kArgumentError = -2;

FakeLslStream* stream_of(void* outlet) {
  return &kState->streams.at(reinterpret_cast<std::uintptr_t>(outlet) - 1);
}

}  // namespace

extern "C" {

FakeLsl* fake_lsl() {
  return kState;
}

void* lsl_create_streaminfo(const char* name, const char* type, std::int32_t channels, double rate,
                            int format, const char* source_id) {
  if (name == nullptr || *name == '\0' || channels < 0 || rate < 0.0 || source_id == nullptr) {
    return nullptr;
  }
  return &kInfos->emplace_back(FakeLslStream{name, type, channels, rate, format, {}, false});
}
void lsl_destroy_streaminfo(void* info) {
  kInfos->remove_if([info](const FakeLslStream& one) { return &one == info; });
}
void* lsl_get_desc(void* info) {
  return info;
}
void* lsl_append_child(void* parent, const char*) {
  return parent;
}
void* lsl_append_child_value(void* parent, const char* name, const char* value) {
  if (std::string(name) == "label") static_cast<FakeLslStream*>(parent)->labels.emplace_back(value);
  return parent;
}
void* lsl_create_outlet(void* info, std::int32_t, std::int32_t) {
  const std::lock_guard lock(kState->mutex);
  if (!kState->makes_outlets) return nullptr;
  kState->streams.push_back(*static_cast<FakeLslStream*>(info));
  kState->streams.back().is_open = true;
  return reinterpret_cast<void*>(kState->streams.size());
}
void lsl_destroy_outlet(void* outlet) {
  const std::lock_guard lock(kState->mutex);
  if (!stream_of(outlet)->is_open) ++kState->misuses;
  stream_of(outlet)->is_open = false;
}
std::int32_t lsl_push_sample_dtp(void* outlet, const double* data, double stamp, std::int32_t) {
  const std::lock_guard lock(kState->mutex);
  const FakeLslStream* const stream = stream_of(outlet);
  if (!stream->is_open) ++kState->misuses;
  if (stream->format != kDouble64) return kArgumentError;
  kState->samples.push_back({stream->name, {data, data + stream->channels}, "", stamp});
  return 0;
}
std::int32_t lsl_push_sample_strtp(void* outlet, const char** data, double stamp, std::int32_t) {
  const std::lock_guard lock(kState->mutex);
  const FakeLslStream* const stream = stream_of(outlet);
  if (!stream->is_open) ++kState->misuses;
  if (stream->format != kString) return kArgumentError;
  kState->samples.push_back({stream->name, {}, data[0], stamp});
  return 0;
}
double lsl_local_clock() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
             .count() +
         kState->ahead_s;
}
}
