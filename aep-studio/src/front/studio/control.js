// The compensator, simulated: PD control without and with it.

function drawControl(state) {
  draw("control", [state.chosen, state.models.map(({ id, name }) => [id, name]), state.control], () => {
    if (state.chosen == null) return [];
    const reference = element("input", { placeholder: "a slow ramp", "aria-label": "reference", autocomplete: "off", spellcheck: "false" });
    const plants = element("select", { "aria-label": "plant" }, ...state.models.map(({ id, name }) => option(id, `${id}: ${name}`, id === state.chosen)));
    const simulate = () => send("/api/task", { task: "control", from: state.chosen, plant: Number(plants.value), reference: reference.value.trim() || null });
    const host = element("div", { class: "simulated" });
    if (state.control) attempt(async () => fill(host, (await ask("/api/control")).html));
    return [
      heading("Friction compensation"),
      element("p", { class: "lead" }, "A simulated PD loop, without and with the force that the chosen model says the friction will take. A plant that knows more shows what a missing effect costs. References: ramp:0.1cm/s, sine:5mm,0.5Hz, trapezoid:20mm,10mm/s,100mm/s2, reversal:1mm/s,2s."),
      element("p", { class: "fields" }, field("To follow", reference), field("Plant", plants), button("Simulate", simulate)),
      ...(state.control ? [element("p", {}, state.control.said), host] : []),
    ];
  });
}
