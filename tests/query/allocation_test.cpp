// Counts what the whole program allocates, so it is a program of its own.

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include <firstcontact/query/first_contact.h>

namespace {

std::atomic<long> allocations{0};

}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) {
    return memory;
  }
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace firstcontact {
namespace {

Shape spiky_disc(int n) {
  Mesh mesh;
  mesh.vertices.emplace_back(0.0, 0.0, 0.0);
  for (int i = 0; i < n; ++i) {
    const double angle = 6.283185307179586 * i / n;
    mesh.vertices.emplace_back(std::cos(angle), std::sin(angle), 0.1 * (i % 7));
  }
  for (int i = 0; i < n; ++i) {
    mesh.triangles.push_back(
        {0, static_cast<std::uint32_t>(1 + i), static_cast<std::uint32_t>(1 + (i + 1) % n)});
  }
  return Shape(std::move(mesh));
}

TEST(FirstContact, AllocatesNothingWhenWarm) {
  const Shape disc = spiky_disc(200);
  const Motion rest = Motion::fixed();
  const Motion fall =
      Motion::constant_velocity({.position = {0.1, 0.2, 2.0}}, {0.0, 0.0, -4.0}, {0.4, 0.3, 2.0});
  Workspace workspace;
  FirstContactResult result;
  const long before_first = allocations;
  first_contact({disc, rest}, {disc, fall}, workspace, {}, result);
  ASSERT_EQ(result.verdict, Verdict::contact);
  ASSERT_FALSE(result.contacts.empty());
  EXPECT_GT(allocations, before_first);  // The counter counts.
  const long before_second = allocations;
  first_contact({disc, rest}, {disc, fall}, workspace, {}, result);
  EXPECT_EQ(allocations, before_second);
}

}  // namespace
}  // namespace firstcontact
