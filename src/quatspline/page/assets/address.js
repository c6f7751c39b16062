/* Views in the address: #section?name=value. A link to a view shows it again. */
"use strict";
quatspline.address = (() => {
  function parts() {
    const [section, query = ""] = location.hash.slice(1).split("?");
    return { section, query };
  }

  /* The parameters of a section's view; null where the address is of another. */
  function read(section) {
    const own = parts();
    return own.section === section && own.query ? new URLSearchParams(own.query) : null;
  }

  function of(section, values) {
    const query = new URLSearchParams(Object.entries(values).filter(([, v]) => v !== "" && v !== null)).toString();
    return `#${section}${query ? `?${query}` : ""}`;
  }

  function write(section, values) {
    history.replaceState(null, "", of(section, values));
  }

  /* Call with the parameters now and whenever the address becomes a view of this section. */
  function follow(section, restore) {
    const now = () => {
      const values = read(section);
      if (!values) return;
      restore(values);
      document.getElementById(section)?.scrollIntoView();
    };
    window.addEventListener("hashchange", now);
    now();
  }

  return { read, of, write, follow };
})();
