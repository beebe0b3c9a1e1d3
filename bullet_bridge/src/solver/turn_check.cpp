// SPDX-License-Identifier: BSD-3-Clause
#include "solver/contact_stores.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <cmath>
#include <cstdio>

#include "log/report.h"
#include "vps_bullet/convert.h"
#include "vps_bullet/turn.h"

namespace vps::bullet {

namespace {

struct Spin {
  double rpm, degrees, limit_degrees, rate_hz;

  Spin(double w_rad_s, double dt_s, double limit_rad)
      : rpm(w_rad_s * 30 / std::numbers::pi),
        degrees(w_rad_s * dt_s * 180 / std::numbers::pi),
        limit_degrees(limit_rad * 180 / std::numbers::pi),
        rate_hz(w_rad_s / limit_rad) {}
};

}  // namespace

void reportClampedTurn(TurnReports& reports, std::span<btCollisionObject* const> bodies, double dt_s) {
  if (!reports.is_on || reports.clamped.test()) return;
  for (const btCollisionObject* object : bodies) {
    const btRigidBody* body = btRigidBody::upcast(object);
    if (!body || body->isStaticOrKinematicObject()) continue;
    const double w_rad_s = body->getAngularVelocity().length();
    if (!(w_rad_s * dt_s > kBulletTurn_rad) || reports.clamped.test_and_set()) continue;
    const Spin spin(w_rad_s, dt_s, kBulletTurn_rad);
    const Vec3 at = fromBt(body->getWorldTransform().getOrigin());
    char words[500];
    std::snprintf(words, sizeof words,
                  "the body at (%.4g, %.4g, %.4g) m turns with %.4g rpm, %.3g degrees in a step. Above "
                  "%.3g degrees Bullet turns a body by less than its angular velocity times the step; %.0f "
                  "steps a second or more avoid this error (substepsFor() of turn.h). Further bodies that "
                  "turn so fast are not reported.",
                  at.x(), at.y(), at.z(), spin.rpm, spin.degrees, spin.limit_degrees,
                  std::ceil(spin.rate_hz * (1 - 1e-9)));
    report(LogLevel::Warning, words);
  }
}

void reportContactTurn(TurnReports& reports, const btCollisionObject& body0, const btCollisionObject& body1,
                       double w_rad_s, double dt_s) {
  if (!reports.is_on || reports.in_contact.test_and_set()) return;
  const Spin spin(w_rad_s, dt_s, kContactTurn_rad);
  const Vec3 at[2] = {fromBt(body0.getWorldTransform().getOrigin()),
                      fromBt(body1.getWorldTransform().getOrigin())};
  char words[500];
  std::snprintf(
      words, sizeof words,
      "the bodies at (%.4g, %.4g, %.4g) m and (%.4g, %.4g, %.4g) m touch and turn against each other "
      "with %.4g rpm, %.3g degrees in a step; above %.3g degrees contacts of teeth or corners may be "
      "missed; %.0f steps a second or more avoid this error (substepsFor() of turn.h). Further bodies "
      "that turn so fast are not reported.",
      at[0].x(), at[0].y(), at[0].z(), at[1].x(), at[1].y(), at[1].z(), spin.rpm, spin.degrees,
      spin.limit_degrees, std::ceil(spin.rate_hz * (1 - 1e-9)));
  report(LogLevel::Warning, words);
}

}  // namespace vps::bullet
