<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis styleCategories="Symbology|Symbology3D" version="3.40.0">
  <renderer-3d layer="" type="vector">
    <vector-layer-3d-tiling zoom-levels-count="3" show-bounding-boxes="0"/>
    <symbol material_type="phong" type="polygon">
      <data culling-mode="back" alt-binding="centroid" extrusion-height="0" rendered-facade="3" add-back-faces="1" alt-clamping="terrain" offset="0" invert-normals="0"/>
      <material diffuse="120,150,185,255" ka="1" kd="1" shininess="0" opacity="1" specular="40,40,40,255" ks="1" ambient="55,70,88,255">
        <data-defined-properties>
          <Option type="Map">
            <Option value="" type="QString" name="name"/>
            <Option name="properties"/>
            <Option value="collection" type="QString" name="type"/>
          </Option>
        </data-defined-properties>
      </material>
      <data-defined-properties>
        <Option type="Map">
          <Option value="" type="QString" name="name"/>
          <Option type="Map" name="properties">
            <Option type="Map" name="extrusionHeight">
              <Option value="true" type="bool" name="active"/>
              <Option value="height" type="QString" name="field"/>
              <Option value="2" type="int" name="type"/>
            </Option>
          </Option>
          <Option value="collection" type="QString" name="type"/>
        </Option>
      </data-defined-properties>
      <edges enabled="1" color="0,52,105,255" width="1"/>
    </symbol>
  </renderer-3d>
  <renderer-v2 attr="source" forceraster="0" enableorderby="0" referencescale="-1" type="categorizedSymbol" symbollevels="0">
    <categories>
      <category symbol="0" value="wall" label="Walls" render="true" type="string"/>
      <category symbol="1" value="roof" label="Roof only" render="true" type="string"/>
    </categories>
    <symbols>
      <symbol name="0" force_rhr="0" frame_rate="10" alpha="1" is_animated="0" clip_to_extent="1" type="fill">
        <layer class="SimpleFill" pass="0" enabled="1" locked="0">
          <Option type="Map">
            <Option name="color" value="0,68,136,50" type="QString"/>
            <Option name="joinstyle" value="miter" type="QString"/>
            <Option name="offset" value="0,0" type="QString"/>
            <Option name="offset_unit" value="MM" type="QString"/>
            <Option name="outline_color" value="0,52,105,255" type="QString"/>
            <Option name="outline_style" value="solid" type="QString"/>
            <Option name="outline_width" value="0.4" type="QString"/>
            <Option name="outline_width_unit" value="MM" type="QString"/>
            <Option name="style" value="solid" type="QString"/>
          </Option>
        </layer>
      </symbol>
      <symbol name="1" force_rhr="0" frame_rate="10" alpha="1" is_animated="0" clip_to_extent="1" type="fill">
        <layer class="SimpleFill" pass="0" enabled="1" locked="0">
          <Option type="Map">
            <Option name="color" value="221,170,51,110" type="QString"/>
            <Option name="joinstyle" value="miter" type="QString"/>
            <Option name="offset" value="0,0" type="QString"/>
            <Option name="offset_unit" value="MM" type="QString"/>
            <Option name="outline_color" value="170,131,39,255" type="QString"/>
            <Option name="outline_style" value="solid" type="QString"/>
            <Option name="outline_width" value="0.4" type="QString"/>
            <Option name="outline_width_unit" value="MM" type="QString"/>
            <Option name="style" value="solid" type="QString"/>
          </Option>
        </layer>
      </symbol>
    </symbols>
  </renderer-v2>
  <blendMode>0</blendMode>
  <featureBlendMode>0</featureBlendMode>
  <layerGeometryType>2</layerGeometryType>
</qgis>
