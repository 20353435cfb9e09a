// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cwchar>
#include <filesystem>
#include <string>
#include <vector>

#include "limen/cli/program.h"

extern "C" {

/// Has the C runtime expand * and ?, which the shells of Windows leave to the program.
extern int _dowildcard;
int _dowildcard = -1;

// std::filesystem::path reads text by mbrtowc(), which knows no UTF-8 in this C runtime: the linker
// (--wrap) gives it this one. A character of four bytes is two words, the second of which goes with its last
// byte.
std::size_t __wrap_mbrtowc(wchar_t* word, const char* text, std::size_t size, std::mbstate_t* state);
std::size_t __wrap_mbrtowc(wchar_t* word, const char* text, std::size_t size, std::mbstate_t* state) {
  constexpr auto kWrong = static_cast<std::size_t>(-1);
  const auto byte = [text](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const auto give = [word](unsigned code, std::size_t length) {
    if (word != nullptr) *word = static_cast<wchar_t>(code);
    return length;
  };
  if (text == nullptr || size == 0) return 0;
  if (*state != 0) {
    const auto second = static_cast<unsigned>(*state);
    *state = 0;
    return give(second, 1);
  }
  const unsigned first = byte(0);
  if (first < 0x80U) return give(first, first == 0 ? 0 : 1);
  const std::size_t length = first >= 0xF0U ? 4 : first >= 0xE0U ? 3 : 2;
  if (first < 0xC2U || size < length) return kWrong;
  unsigned code = first & (0x7FU >> length);
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(k) & 0xC0U) != 0x80U) return kWrong;
    code = code << 6U | (byte(k) & 0x3FU);
  }
  if (length < 4) return give(code, length);
  *state = static_cast<int>(0xDC00U + ((code - 0x10000U) & 0x3FFU));
  return give(0xD800U + ((code - 0x10000U) >> 10U), 3);
}

/// The words are UTF-8 within limen, on every system.
int wmain(int argc, wchar_t** argv) {
  std::vector<std::string> texts;
  for (int k = 0; k < argc; ++k) texts.push_back(std::filesystem::path(argv[k]).string());
  std::vector<char*> words;
  for (std::string& text : texts) words.push_back(text.data());
  const int status = limen::run_program(argc, words.data());
  std::fflush(nullptr);
  // Threads that wait for work end with the process: to join them after main() can hang here.
  std::_Exit(status);
}
}
