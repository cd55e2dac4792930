/// Drawings of 24 by 24, drawn with lines.

export const icons = {
  play: "M7 4.5v15l12-7.5z",
  pause: "M8 5v14M16 5v14",
  start: "M18 5v14l-10-7zM6 5v14",
  back: "M16 5l-9 7 9 7",
  forward: "M8 5l9 7-9 7",
  contact: "M3 12h5M16 12h5M12 3v5M12 16v5M12 9.5a2.5 2.5 0 1 0 .001 0",
  loop: "M4 11a7 7 0 0 1 12-5l3 3M20 13a7 7 0 0 1-12 5l-3-3M19 4v5h-5M5 20v-5h5",
  fit: "M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5",
  wireframe: "M12 3l8 4.5v9L12 21l-8-4.5v-9zM12 12l8-4.5M12 12v9M12 12L4 7.5",
  xray: "M4 4h11v11H4zM9 9h11v11H9z",
  cutaway: "M12 3v18M12 6h7v12h-7M5 6h3M5 6v3M5 11v2M5 15v3h3",
  edges: "M4 17L12 3l8 14zM12 3v18M4 17l8 4 8-4",
  ghosts:
    "M4 8h7v8H4zM14 8h1.500M17.500 8H20v2M20 12v1.500M20 15.500V16h-2M15.500 16H14v-2M14 12v-1.500",
  onion: "M8 12a4 6 0 1 0 .001 0M6 6a9 9 0 0 1 9 6a9 9 0 0 1-9 6M12 6a9 9 0 0 1 7 6a9 9 0 0 1-7 6",
  marker: "M12 21c-4-5-6-8-6-11a6 6 0 0 1 12 0c0 3-2 6-6 11zM12 8a2 2 0 1 0 .001 0",
  force: "M5 19L18 6M10 5.500h8.500V14M4 16v4h4",
  measure: "M3 16L16 3l5 5L8 21zM7 12l2 2M10 9l3 3M13 6l2 2",
  image: "M4 5h16v14H4zM4 16l5-5 4 4 3-3 4 4M15.500 8a1 1 0 1 0 .001 0",
  export: "M12 3v12M7 10l5 5 5-5M4 20h16",
  theme: "M12 4a8 8 0 1 0 .001 0M12 4v16M12 8l5-2M12 12h8M12 16l5 2",
  help: "M9 9a3 3 0 1 1 4 3c-1 .500-1 1-1 2M12 17.500v.500",
  panel: "M4 5h16v14H4zM14 5v14",
  eye: "M2 12c3-5 6-7 10-7s7 2 10 7c-3 5-6 7-10 7s-7-2-10-7zM12 9a3 3 0 1 0 .001 0",
  hidden:
    "M3 3l18 18M6 7c-1.500 1-3 3-4 5 3 5 6 7 10 7 2 0 3.500-.500 5-1.500M10 5.200c4-.800 8.500 1.300 12 6.800-.700 1.200-1.500 2.200-2.300 3",
  close: "M5 5l14 14M19 5L5 19",
  visual: "M12 3a9 9 0 1 0 .001 0M3 12h18",
} as const;
