/// The feature pairs that touch at the first contact.

import { element } from "../core/dom";
import { directionText, lengthText, pointText } from "../core/format";
import type { Contact } from "../data/result";
import type { Model } from "../model";
import type { Player } from "../player";
import type { SceneView } from "../view/scene_view";

const firstRowsOf = ({ robots }: Model): number => (robots.length > 0 ? 2 : 4); // Joints follow.
const mostRows = 100;

function featureText(model: Model, contact: Contact, side: 0 | 1): string {
  const { type, index } = contact.features[side];
  const several = model.body(contact.bodies[side]).geometries.length > 1;
  const geometry = several ? ` of geometry ${contact.geometries?.[side] ?? 0}` : "";
  return `${model.shortName(contact.bodies[side])} ${type} ${index}${geometry}`;
}

function speedText(speed: number): string {
  return `${speed < 0 ? "closing" : "parting"} at ${lengthText(Math.abs(speed), 3)}/s`;
}

function description(contact: Contact, grain: number): HTMLElement {
  const lines = [
    `at ${pointText(contact.points[0], 6, grain)}`,
    `distance ${lengthText(contact.distance, 4, { grain })}`,
    ...(contact.normal ? [`normal ${directionText(contact.normal)}`] : []),
    ...(contact.normal_velocity === null ? [] : [speedText(contact.normal_velocity)]),
  ];
  return element("span.lines", {}, ...lines.map((line) => element("span", {}, line)));
}

/// Null where nothing touches.
export function contactsPanel(model: Model, view: SceneView, player: Player): HTMLElement | null {
  const { contacts } = model;
  if (contacts.length === 0) {
    return null;
  }
  const firstRows = firstRowsOf(model);
  const row = (contact: Contact): HTMLElement => {
    const title = `${featureText(model, contact, 0)} · ${featureText(model, contact, 1)}`;
    const button = element(
      "button.row-name.tall",
      { type: "button", "data-points": JSON.stringify(contact.points) },
      element("span.name", {}, title),
      description(contact, model.grain),
    );
    button.addEventListener("click", () => {
      player.toContact();
      view.showContacts(contacts, model.contactTime);
      view.focusContact(contact);
    });
    return element("li", {}, button);
  };
  const list = element("ul.rows", {}, ...contacts.slice(0, firstRows).map(row));
  const more = element(
    "button.link",
    { type: "button", hidden: contacts.length <= firstRows },
    `Show ${Math.min(contacts.length, mostRows)} of ${contacts.length}`,
  );
  more.addEventListener("click", () => {
    list.append(...contacts.slice(firstRows, mostRows).map(row));
    more.hidden = true;
  });
  return element(
    "section.card",
    { "aria-label": "Contacts" },
    element("h2", {}, "Contacts ", element("span.count", {}, String(contacts.length))),
    list,
    more,
  );
}
