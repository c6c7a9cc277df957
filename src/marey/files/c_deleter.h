#pragma once

#include <new>

namespace marey {

/// An object that a C library has allocated. Throws std::bad_alloc if it found no memory.
template <typename T>
T* allocated(T* object) {
  if (object == nullptr) throw std::bad_alloc();
  return object;
}

/// For a std::unique_ptr to what a C library frees through a pointer to its pointer.
template <typename T, void (*Free)(T**)>
struct CDeleter {
  void operator()(T* object) const { Free(&object); }
};

}  // namespace marey
