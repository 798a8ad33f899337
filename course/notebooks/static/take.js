// The questions of an attempt, one group of options each. The page does not know which one is right.

export default {
  render({ model, el }) {
    el.addEventListener("focusin", (event) => {
      event.target.dataset.lmSuppressShortcuts = "true";
    });
    const made = (name, text, style = "") => {
      const element = document.createElement(name);
      element.textContent = text;
      element.style.cssText = style;
      return element;
    };
    const here = `quiz-${Math.random().toString(36).slice(2)}`;
    const form = document.createElement("form");
    const said = made("p", "");
    said.setAttribute("role", "status");
    const question = (asked, index, all) => {
      const group = made("fieldset", "", "margin: 0 0 1em; padding: 0.6em 1em; min-width: 0");
      group.append(made("legend", `Question ${index + 1} of ${all.length}: ${asked.title}`, "font-weight: bold"));
      group.append(made("p", asked.prompt, "white-space: pre-wrap"));
      for (const option of asked.options) {
        const label = made("label", "", "display: block; margin: 0.3em 0");
        const choice = document.createElement("input");
        Object.assign(choice, { type: "radio", name: `${here}-${asked.id}`, value: option.letter });
        choice.required = true;
        choice.checked = option.letter === asked.answered;
        label.append(choice, ` ${option.letter}. ${option.text}`);
        group.append(label);
      }
      group.disabled = asked.answered !== "";
      group.dataset.question = asked.id;
      return group;
    };
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      const answers = {};
      for (const group of form.querySelectorAll("fieldset"))
        answers[group.dataset.question] = group.querySelector("input:checked")?.value ?? "";
      model.send({ kind: "answers", answers });
    });
    const hear = (message) => {
      if (message.kind === "questions")
        form.replaceChildren(...message.questions.map(question), made("button", "Hand in and see the marks"));
      else if (message.kind === "done") {
        for (const part of form.elements) part.disabled = true;
        said.textContent = "Marked; see below.";
      }
    };
    model.on("msg:custom", hear);
    el.replaceChildren(form, said);
    model.send({ kind: "hello" });
    return () => model.off("msg:custom", hear);
  },
};
