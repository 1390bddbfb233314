#pragma once

#include <ImfIO.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

// What OpenEXR reads from and writes to here: bytes in memory.
namespace likeness::image {

// A file in memory, written from the start and patched at the end (OpenEXR goes back to its line table).
class MemoryFile : public Imf::OStream {
 public:
  MemoryFile() : Imf::OStream("memory") {}
  void write(const char bytes[], int count) override {
    const std::size_t end = at_ + static_cast<std::size_t>(count);
    if (content_.size() < end) {
      if (content_.capacity() < end) content_.reserve(std::max(end, 2 * content_.capacity()));
      content_.resize(end);
    }
    content_.replace(at_, static_cast<std::size_t>(count), bytes, static_cast<std::size_t>(count));
    at_ = end;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t at) override { at_ = at; }
  const std::string& content() const { return content_; }

 private:
  std::string content_;
  std::size_t at_ = 0;
};

// Bytes that somebody else keeps. Reading beyond their end throws, as OpenEXR expects of a file that is cut off.
class MemoryInput : public Imf::IStream {
 public:
  explicit MemoryInput(std::string_view bytes) : Imf::IStream("memory"), bytes_(bytes) {}
  bool isMemoryMapped() const override { return true; }
  char* readMemoryMapped(int count) override { return const_cast<char*>(taken(count)); }  // OpenEXR only reads there
  bool read(char into[], int count) override {
    std::memcpy(into, taken(count), static_cast<std::size_t>(count));
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t at) override { at_ = at; }

 private:
  const char* taken(int count) {
    if (count < 0 || at_ > bytes_.size() || static_cast<std::size_t>(count) > bytes_.size() - at_)
      throw std::runtime_error("the file ends too early");
    const char* const from = bytes_.data() + at_;
    at_ += static_cast<std::size_t>(count);
    return from;
  }
  std::string_view bytes_;
  std::uint64_t at_ = 0;
};

}  // namespace likeness::image
