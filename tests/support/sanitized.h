#pragma once

// RAILSTEP_SANITIZED is defined under the address and the thread sanitizer, which have a heap, a
// stack and a pace of their own. g++ and clang say it in two ways.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define RAILSTEP_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define RAILSTEP_SANITIZED
#endif
#endif
