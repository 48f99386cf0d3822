export { AmbientLight, BufferAttribute, BufferGeometry, Color, DirectionalLight, DoubleSide, Group, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, MeshLambertMaterial, OrthographicCamera, PerspectiveCamera, Plane, Scene, Vector3, WebGLRenderer } from 'three';
export { TrackballControls } from 'three/addons/controls/TrackballControls.js';
