// A triangle falls 2 m onto another one 1 m below it: they touch half way through the step.

#include <cmath>
#include <iostream>

#include <firstcontact/query/first_contact.h>

int main() {
  const firstcontact::Mesh mesh{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                .triangles = {{0, 1, 2}}};
  const firstcontact::Shape triangle(mesh);
  const firstcontact::Motion rest = firstcontact::Motion::fixed();
  const firstcontact::Motion fall = firstcontact::Motion::constant_velocity(
      {.position = {0.1, 0.1, 1.0}}, /*translation=*/{0, 0, -2});

  firstcontact::Workspace workspace;
  const firstcontact::FirstContactResult result =
      firstcontact::first_contact({triangle, rest}, {triangle, fall}, workspace);

  std::cout << "first contact at t = " << result.t << '\n';
  const bool right = result.verdict == firstcontact::Verdict::contact && result.t <= 0.5 &&
                     std::abs(result.t - 0.5) < 1e-6;
  return right ? 0 : 1;
}
