#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>
#include <utility>
#include <vector>

#include <sys/mman.h>

namespace likeness::image {

// Memory that is 0 and that nobody has touched: the system hands out each page when it is first used, to the thread
// that uses it, in pages of 2 MB where it has them. A large buffer of zeros costs nothing before it is worked on, and
// then as many threads fetch it as work on it.
template <class T>
struct UntouchedMemory {
  static_assert(alignof(T) <= alignof(std::max_align_t));
  using value_type = T;

  UntouchedMemory() = default;
  template <class U>
  UntouchedMemory(const UntouchedMemory<U>&) {}

  T* allocate(std::size_t count) {
    if (count > (static_cast<std::size_t>(-1) - 2 * kLargePage) / sizeof(T)) throw std::bad_alloc();
    if (count * sizeof(T) < kLargePage) {
      void* small = std::calloc(count, sizeof(T));
      if (small == nullptr) throw std::bad_alloc();
      return static_cast<T*>(small);
    }
    // A page more, so that some part of it begins at a large page; the rest is given back.
    const std::size_t bytes = whole_pages(count), spare = kLargePage;
    void* at = ::mmap(nullptr, bytes + spare, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (at == MAP_FAILED) throw std::bad_alloc();
    auto* first = static_cast<std::byte*>(at);
    const std::size_t before = (kLargePage - reinterpret_cast<std::size_t>(first) % kLargePage) % kLargePage;
    if (before > 0) ::munmap(first, before);
    if (spare > before) ::munmap(first + before + bytes, spare - before);
    ::madvise(first + before, bytes, MADV_HUGEPAGE);  // where the system has none, small pages do
    return reinterpret_cast<T*>(first + before);
  }
  void deallocate(T* at, std::size_t count) {
    if (count * sizeof(T) < kLargePage) std::free(at);
    else ::munmap(at, whole_pages(count));
  }

  // A number that is made without a value is what its memory is: 0.
  template <class U>
  void construct(U*) noexcept {}
  template <class U, class First, class... Rest>
  void construct(U* at, First&& first, Rest&&... rest) {
    ::new (static_cast<void*>(at)) U(std::forward<First>(first), std::forward<Rest>(rest)...);
  }

  friend bool operator==(UntouchedMemory, UntouchedMemory) { return true; }

 private:
  static constexpr std::size_t kLargePage = std::size_t{2} << 20;
  static std::size_t whole_pages(std::size_t count) {
    return (count * sizeof(T) + kLargePage - 1) / kLargePage * kLargePage;
  }
};

// As many values as it is made with, all bits of them 0. It must not grow afterwards: what it had held would show.
template <class T>
using Plane = std::vector<T, UntouchedMemory<T>>;

}  // namespace likeness::image
