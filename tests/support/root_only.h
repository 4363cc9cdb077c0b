#pragma once

#include <unistd.h>

#include <catch2/catch.hpp>

/// First line of a test that makes namespaces as root. CTest reports "Skipped" for the text.
// NOLINTNEXTLINE(cppcoreguidelines-macro-usage): it returns from the test
#define CUSCUS_ROOT_ONLY()                         \
  do {                                             \
    if (::geteuid() != 0) {                        \
      WARN("SKIPPED: needs root, and is not run"); \
      return;                                      \
    }                                              \
  } while (false)
