/// \file Whether the tests run with a sanitizer, which replaces memory functions.
#pragma once

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define TOUCHTRIAL_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define TOUCHTRIAL_SANITIZED
#endif
#endif

namespace touchtrial {

#ifdef TOUCHTRIAL_SANITIZED
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace touchtrial
