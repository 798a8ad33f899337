// A field for a prediction, and two buttons. The answer is not in this page until one of them is pressed. Then
// three more ask how the prediction did.

export default {
  render({ model, el }) {
    el.addEventListener("focusin", (event) => {
      event.target.dataset.lmSuppressShortcuts = "true";
    });
    const field = document.createElement("textarea");
    field.rows = 3;
    field.style.cssText = "display: block; width: 100%; box-sizing: border-box; font: inherit; padding: 0.4em";
    field.setAttribute("aria-label", "Your prediction");
    field.className = "course-prediction";
    field.placeholder = "What do you expect, and why? You learn most from a guess that you wrote down.";
    const say = (text) => model.send({ kind: "predict", text });
    const button = (words, act) => {
      const made = document.createElement("button");
      made.textContent = words;
      made.style.cssText = "margin: 0.4em 0.4em 0.4em 0";
      made.addEventListener("click", act);
      return made;
    };
    const keep = button("Keep it and open the answer", () => (field.value.trim() ? say(field.value) : field.focus()));
    const skip = button("Skip", () => say(""));
    const compare = document.createElement("div");
    compare.hidden = true;
    compare.append("Compare it with the answer below. You were: ");
    for (const [word, words] of [["right", "right"], ["nearly", "nearly right"], ["wrong", "wrong"]])
      compare.append(button(words, () => model.send({ kind: "judge", word })));
    const hear = (message) => {
      if (message.kind !== "kept") return;
      for (const part of [field, keep, skip]) part.disabled = true;
      compare.hidden = !message.waits;
    };
    model.on("msg:custom", hear);
    el.replaceChildren(field, keep, skip, compare);
    model.send({ kind: "hello" });
    return () => model.off("msg:custom", hear);
  },
};
